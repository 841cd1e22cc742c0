// SPDX-License-Identifier: Apache-2.0
// Pictures of the page with each of the four systems, in the middle of what it does.
import {writeFile} from 'node:fs/promises';
import {join} from 'node:path';
import {deflateSync, inflateSync} from 'node:zlib';

import {monitor, openPage, run, sleep, until} from './running.mjs';

const kSystem = ['--set', 'clock=system'];
const kTries = 4;
/// The deployment, what the operator was told when the picture is taken, and how long after that.
const kPictures = [
  ['lamp', ['dental_lamp'], 'holding', 3],
  ['sr1', ['sr1_biopsy', ...kSystem], 'at target', 0.1],
  ['implant', ['dental_implant', ...kSystem], 'drilling', 2.1],
  ['master', ['master_manipulator', ...kSystem], 'clutch open', 4.5],
];

/// `names`: of those that are wanted; none: all.
export async function screenshots(domain, folder, names = []) {
  for (const [name, ...how] of kPictures) {
    if (names.length > 0 && !names.includes(name)) continue;
    // On a busy machine a deployment in real time may stop before it is there: it begins again.
    for (let left = kTries; left > 0 && !(await picture(domain, join(folder, name, 'page.png'), ...how)); --left) continue;
  }
}

async function picture(domain, file, words, text, seconds) {
  const server = await monitor(domain), page = await openPage(server.url), deployment = run(domain, words);
  const told = (wanted) => page.evaluate((one) => armature.log.events.some((event) => event.text.startsWith(one)), wanted);
  const isThere = await until(async () => (await told(text)) ? 'yes' : (await told('refused')) && 'no', `'${text}'`, 240_000) === 'yes';
  if (isThere) {
    await sleep(seconds);
    await writeFile(file, smaller(await page.screenshot()));
    console.log(`${file}: ${await page.locator('.performance').textContent()}`);
  }
  await page.close();
  await deployment.end();
  await server.end();
  return isThere;
}

/// The same picture, packed as small as zlib can.
function smaller(png) {
  const chunks = [], data = [];
  for (let at = 8; at < png.length;) {
    const length = png.readUInt32BE(at), type = png.toString('latin1', at + 4, at + 8);
    if (type === 'IDAT') data.push(png.subarray(at + 8, at + 8 + length));
    else chunks.push([type, png.subarray(at + 8, at + 8 + length)]);
    at += 12 + length;
  }
  chunks.splice(-1, 0, ['IDAT', deflateSync(inflateSync(Buffer.concat(data)), {level: 9, memLevel: 9})]);
  return Buffer.concat([png.subarray(0, 8), ...chunks.map(([type, bytes]) => {
    const named = Buffer.concat([Buffer.from(type, 'latin1'), bytes]), ends = Buffer.alloc(4), begins = Buffer.alloc(4);
    begins.writeUInt32BE(bytes.length);
    ends.writeUInt32BE(crc32(named));
    return Buffer.concat([begins, named, ends]);
  })]);
}

function crc32(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let i = 0; i < 8; ++i) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}
