// SPDX-License-Identifier: Apache-2.0
// Pictures of the page with each of the four systems, in the middle of what it does.
import {join} from 'node:path';

import {monitor, openPage, run, sleep, until} from './running.mjs';

const kSystem = ['--set', 'clock=system'];
/// The deployment, what the operator was told when the picture is taken, and how long after that.
const kPictures = [
  ['lamp', ['dental_lamp'], 'holding', 3],
  ['sr1', ['sr1_biopsy', ...kSystem], 'at target', 0.1],
  ['implant', ['dental_implant', ...kSystem], 'drilling', 3.2],
  ['master', ['master_manipulator', ...kSystem], 'clutch open', 4.5],
];

export async function screenshots(domain, folder) {
  for (const [name, words, text, seconds] of kPictures) {
    const server = await monitor(domain);
    const page = await openPage(server.url);
    const deployment = run(domain, words);
    await until(() => page.evaluate((wanted) => armature.log.events.some((event) => event.text.startsWith(wanted)), text), `${name} to tell '${text}'`, 240_000);
    await sleep(seconds);
    const file = join(folder, name, 'page.png');
    await page.screenshot({path: file});
    console.log(`${file}: ${await page.locator('.performance').textContent()}`);
    await page.close();
    await deployment.end();
    await server.end();
  }
}
