// SPDX-License-Identifier: Apache-2.0
// One scenario in a browser: node tests/browser.mjs SCENARIO DOMAIN
// ARMATURE says which program is looked at; pictures: node tests/browser.mjs screenshots DOMAIN FOLDER [NAME..]
import {endAll, monitor} from './running.mjs';
import {scenarios} from './scenarios.mjs';
import {screenshots} from './screenshots.mjs';

const [name, domain, folder, ...names] = process.argv.slice(2);
const scenario = name === 'screenshots' ? (one) => screenshots(one, folder, names) : scenarios[name];
if (!scenario || !domain) {
  console.error(`node tests/browser.mjs SCENARIO DOMAIN; there are ${Object.keys(scenarios).join(', ')}, screenshots`);
  process.exit(2);
}
let code = 0;
try {
  if (name === 'nonsense') process.env.PAGE_URL = (await monitor(domain)).url;
  await scenario(Number(domain));
  console.log(`${name}: ok`);
} catch (error) {
  console.error(error.stack ?? error);
  code = 1;
}
await endAll();
process.exit(code);
