// SPDX-License-Identifier: Apache-2.0
// What the page shows is what there is: each scenario looks at it beside what the command line, or
// another client, tells of the same deployment.
import assert from 'node:assert/strict';
import {copyFile, mkdtemp, readFile, rm, truncate, writeFile} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';

import {decodeLive, decodeRecording, lazyClients} from './clients.mjs';
import {fakeServer} from './fake_server.mjs';
import {monitor, openPage, output, played, run, sample, sleep, until} from './running.mjs';

const kLampArm = ['dental_lamp'];
const app = (page, look, argument) => page.evaluate(look, argument);
const near = (a, b, tolerance, what) => assert.ok(Math.abs(a - b) <= tolerance, `${what}: ${a} is not ${b} to ${tolerance}`);

async function lampPage(domain, words = kLampArm) {
  const server = await monitor(domain);
  const deployment = run(domain, words);
  const page = await openPage(server.url);
  await until(() => app(page, () => armature.deployment?.components.length > 0), 'the components of the deployment');
  return {server, deployment, page};
}
/// Positions of the arm's links as they are drawn, by name.
const links = (page) => app(page, () => Object.fromEntries([...armature.scene.robots.links()].map(([name, link]) => {
  link.updateWorldMatrix(true, false);
  return [name, link.matrixWorld.elements.slice(12, 15)];
})));

/// The links that urdf-loader places by the joints are where /tf, which is forward kinematics of the
/// framework, has them, and the tool is where the command line reads it.
async function arm(domain) {
  const {page} = await lampPage(domain);
  await until(() => app(page, () => armature.log.events.some(({text}) => text === 'holding')), 'the lamp to hold');
  await sleep(1);
  await page.keyboard.press('Space');
  await sleep(0.5);
  const drawn = await links(page);
  const told = await app(page, (names) => Object.fromEntries(names.flatMap((name) => {
    const matrix = armature.scene.frames.toRoot(name);
    return matrix ? [[name, matrix.elements.slice(12, 15)]] : [];
  })), Object.keys(drawn));
  assert.ok(Object.keys(told).length >= 7, `links on /tf: ${Object.keys(told)}`);
  for (const [name, place] of Object.entries(told)) {
    place.forEach((value, i) => near(drawn[name][i], value, 1e-5, `link ${name}, axis ${i}`));
  }
  const tool = (await sample(domain, '/dental_lamp/tool_pose')).pose.position;
  ['x', 'y', 'z'].forEach((axis, i) => near(told.tool?.[i] ?? drawn.tool[i], tool[axis], 1e-3, `tool ${axis} [m]`));
  const markers = await app(page, () => armature.scene.markerNames());
  for (const wanted of ['pointing/1', 'target/0', 'truth/0']) assert.ok(markers.includes(wanted), `${wanted} in ${markers}`);
  assert.ok(!markers.some((name) => name.startsWith('links/')), 'the robot is drawn once');
  const lit = await page.locator('.scene canvas').screenshot();
  assert.ok(lit.length > 8000, 'the picture of the arm is not empty');
  assert.deepEqual(page.problems, []);
}

/// Both pictures come as JPEG with 68 landmarks over each, at the rate of the cameras.
async function pictures(domain) {
  const {page} = await lampPage(domain);
  await until(() => app(page, () => armature.images.length === 2 && armature.images.every(({landmarks}) => landmarks === 68)), '68 landmarks in both pictures');
  const wanted = await app(page, () => armature.images.flatMap((image) => image.topics(armature.view())));
  assert.ok(wanted.includes('/dental_lamp/left/image_raw/compressed') && wanted.includes('/dental_lamp/right/image_raw/compressed'), `${wanted}`);
  assert.ok(!wanted.some((topic) => topic.endsWith('/image_raw')), 'no picture comes raw where there is a JPEG');
  // A panel that nobody sees asks for nothing.
  await page.keyboard.press('1');
  await until(() => app(page, () => !armature.hub.isWanted('/dental_lamp/left/image_raw/compressed')), 'the pictures to be left alone');
  await page.keyboard.press('Escape');
  await until(() => app(page, () => armature.hub.isWanted('/dental_lamp/left/image_raw/compressed')), 'the pictures to come again');
  assert.deepEqual(page.problems, []);
}

/// Every message of a topic is a point of its curve, the errors against their goals come first, and
/// any other number can be added.
async function plots(domain) {
  const {page} = await lampPage(domain);
  await until(() => app(page, () => armature.plots[0]?.shown[0]?.curve.times.length > 20), 'points');
  const told = await app(page, () => {
    const [{series, curve}] = armature.plots[0].shown, log = armature.hub.log('/dental_lamp/target');
    armature.plots[0].update(armature.view());
    return {goal: armature.plots[0].goalOf(series), points: curve.times.length, messages: log.length, label: series.label};
  });
  assert.equal(told.goal, 2.5, `the goal of '${told.label}' is that of the deployment file`);
  assert.ok(told.points === told.messages, `${told.points} points of ${told.messages} messages`);
  await page.locator('.plot1 summary').click();
  await page.locator('.plot1 input').fill('/joint_states');
  await page.locator('.plot1 input').press('Tab');
  await until(() => page.locator('.plot1 .adder option[value="position[5]"]').count(), 'the numbers of /joint_states');
  await page.locator('.plot1 .adder select').selectOption('position[2]');
  await page.locator('.plot1 .adder button').click();
  const added = await until(() => app(page, () => {
    const {curve} = armature.plots[0].shown.at(-1), log = armature.hub.log('/joint_states');
    return curve.times.length > 20 && {value: curve.values.at(-1), joint: log.at(curve.times.at(-1)).position[2]};
  }), 'points of the added curve');
  assert.equal(added.value, added.joint);
  assert.deepEqual(page.problems, []);
}

/// Every component and its state stand in the graph as component_states tells them; a click shows
/// parameters and ports as the description has them.
async function graph(domain) {
  const {page} = await lampPage(domain);
  await until(() => page.locator('.graph .node[data-state="ok"]').count(), 'a component that is ok');
  const told = await sample(domain, '/dental_lamp/component_states');
  const names = told.components.map(({component}) => component).sort();
  const words = ['ok', 'degraded', 'fault', 'stalled'];
  // On a busy machine a state may change in between: both are looked at until they agree.
  await until(async () => {
    const now = await sample(domain, '/dental_lamp/component_states');
    const shown = await page.locator('.graph .node').evaluateAll((nodes) => nodes.map((node) => [node.dataset.component, node.dataset.state]));
    assert.deepEqual(shown.map(([name]) => name).sort(), names);
    return now.components.every(({component, state}) => shown.some(([name, word]) => name === component && word === words[state]));
  }, 'the same states in the graph and on component_states');
  await page.locator('.graph .node[data-component="scene"]').click();
  const inspector = page.locator('.inspector');
  const row = inspector.locator('tr', {hasText: 'rate_hz'});
  assert.deepEqual(await row.locator('td').allTextContents(), ['rate_hz', '10', 'default of sim/photo_scene']);
  assert.ok(await inspector.getByText('/dental_lamp/left/image_raw', {exact: true}).count(), 'its ports');
  await page.keyboard.press('Escape');
  assert.ok(await inspector.isHidden());
  // The same by keyboard alone.
  await page.locator('.graph .node[data-component="task"]').focus();
  await page.keyboard.press('Enter');
  assert.ok(await inspector.getByText('task/lamp_alignment', {exact: false}).count());
  assert.deepEqual(page.problems, []);
}

/// Paused and gone back, the page shows what was: joints, states, pictures of that time.
async function scrub(domain) {
  const {page} = await lampPage(domain);
  await until(() => app(page, () => armature.log.events.some(({text}) => text === 'holding')), 'the lamp to hold');
  await page.keyboard.press('Space');
  const [now, then] = [await links(page), await (async () => {
    for (let i = 0; i < 3; ++i) await page.keyboard.press('ArrowLeft');
    await sleep(0.6);
    return links(page);
  })()];
  const told = await app(page, () => {
    const {t, hub} = armature.view();
    return {back: armature.playhead.end - t, tool: hub.at('/dental_lamp/tool_pose', t).pose.position,
            label: document.querySelector('.when').textContent};
  });
  assert.ok(told.back >= 3, `${told.back} s back`);
  ['x', 'y', 'z'].forEach((axis, i) => near(then.tool[i], told.tool[axis], 2e-3, `tool ${axis} then [m]`));
  assert.ok(Math.hypot(...[0, 1, 2].map((i) => then.tool[i] - now.tool[i])) > 1e-3, 'it has moved since');
  assert.match(told.label, /^-\d+\.\d s$/);
  assert.ok(await page.locator('select.speed').isHidden(), 'a running deployment has no speed');
  // What is looked at stays, while new messages come.
  await sleep(1);
  assert.deepEqual(await links(page), then);
  await page.keyboard.press('Space');
  await until(() => app(page, () => armature.playhead.isLive), 'the page to be live');
  assert.deepEqual(page.problems, []);
}

/// A monitor that dies and comes back, and a deployment that ends and is started anew: the page says
/// so and follows, without being loaded again.
async function again(domain) {
  const {server, deployment, page} = await lampPage(domain);
  await app(page, () => (globalThis.isThisPage = true));
  await server.end('SIGKILL');
  await until(() => page.locator('.connection.lost').count(), 'the page to say that the connection is lost', 10_000);
  const server2 = await monitor(domain, server.port);
  const [before, points] = await app(page, () => [armature.hub.received, armature.plots[0].shown[0].curve.times.length]);
  await until(() => app(page, (count) => armature.hub.condition === 'connected' && armature.hub.received > count + 100, before), 'messages after the connection was made again', 30_000);
  assert.ok(await app(page, () => armature.plots[0].shown[0].curve.times.length) >= points, 'what was remembered before is still there');
  const lines = await page.locator('.log .text').allTextContents();
  assert.equal(lines.filter((line) => line === 'checking light').length, 1, 'what the operator was told stands there once');
  const run1 = await app(page, () => armature.deployment.run);
  await deployment.end();
  const next = run(domain, kLampArm);
  await until(() => app(page, (old) => armature.deployment?.run && armature.deployment.run !== old && armature.deployment.components.length > 10, run1), 'the new run', 60_000);
  await until(() => app(page, () => armature.scene.robots.count === 1), 'the arm of the new run');
  assert.ok(await app(page, () => isThisPage), 'it was not loaded again');
  assert.deepEqual(page.problems, []);
  await next.end();
  await server2.end();
}

/// A recording shows as many messages as `armature info` counts, plays, and is read without its index,
/// too, to its last whole chunk.
async function recording(domain) {
  const folder = await mkdtemp(join(tmpdir(), 'armature-page-'));
  try {
    const deployment = run(domain, kLampArm);
    const file = join(folder, 'run.mcap'), cut = join(folder, 'cut.mcap');
    await output(['record', '-o', file, '--timeout', '6', '--domain', String(domain)]);
    await deployment.end();
    const messagesOf = (info) => info.topics.reduce((sum, {messages}) => sum + messages, 0);
    const messages = messagesOf(JSON.parse(await output(['info', file, '--json'])));
    const server = await monitor(domain), page = await openPage(server.url);
    await page.locator('#open').setInputFiles(file);
    await until(() => app(page, () => armature.hub.condition === 'read'), 'the recording');
    const counted = Object.values(await app(page, () => Object.fromEntries([...armature.hub.topics.values()].map(({name, count}) => [name, count])))).reduce((a, b) => a + b, 0);
    assert.equal(await app(page, () => armature.hub.recording.file.messages), messages);
    assert.equal(counted, messages, 'of all topics');
    assert.ok(await page.locator('.connection').getByText(`${messages} messages`).count(), 'it says how many');
    await page.keyboard.press('End');
    await until(() => app(page, () => armature.scene.robots.count === 1 && armature.images.every(({pictures}) => pictures > 0)), 'arm and pictures of the recording');
    await decodeRecording(file, messages);
    await copyFile(file, cut);
    await truncate(cut, Math.floor((await readFile(file)).length * 0.6));
    const cutInfo = JSON.parse(await output(['info', cut, '--json']).catch((error) => error.stdout));
    await page.locator('#open').setInputFiles(cut);
    await until(() => app(page, () => armature.hub.recording?.file.name === 'cut.mcap'), 'the recording that was cut off');
    const streamed = await app(page, () => ({messages: armature.hub.recording.file.messages, remark: armature.hub.recording.file.remark}));
    assert.match(streamed.remark, /was not ended/);
    assert.equal(streamed.messages, messagesOf(cutInfo));
    await writeFile(cut, 'this is no recording');
    await page.locator('#open').setInputFiles(cut);
    await until(() => page.locator('.log').getByText('is no recording that can be read').count(), 'the page to say so');
    assert.deepEqual(page.problems, []);
  } finally {
    await rm(folder, {recursive: true});
  }
}

/// A recording that a server plays is paused, sought in and made faster by the page, with keys, mouse and
/// finger, for all who watch it; what the page shows then is what was so at that time.
async function playback(domain) {
  const folder = await mkdtemp(join(tmpdir(), 'armature-page-'));
  try {
    const file = join(folder, 'run.mcap');
    const deployment = run(domain, kLampArm);
    await output(['record', '-o', file, '--timeout', '10', '--domain', String(domain)]);
    await deployment.end();
    const server = await played(file);
    const page = await openPage(server.url);
    const of = (one) => one.evaluate(() => {
      const {start, end, position, speed, isPlaying} = armature.playhead;
      return {at: position - start, span: end - start, speed, isPlaying, shown: armature.hub.store.newest - start, store: armature.hub.store.newest};
    });
    await until(async () => (await of(page)).at > 0.5 && (await of(page)).isPlaying, 'it to play, and to say so');
    const tablet = await openPage(server.url, {width: 1024, height: 768}, true);
    await until(async () => (await of(tablet)).isPlaying, 'the other page to say so, too');
    assert.ok((await of(page)).span > 5, 'the bar is that of the whole recording');
    await page.keyboard.press('Space');
    await until(async () => !(await of(tablet)).isPlaying, 'the pause to be told to the other page');
    await sleep(0.3);
    const still = (await of(page)).store;
    await sleep(0.5);
    assert.equal((await of(page)).store, still, 'no message comes while it is paused');
    // Sought with the mouse: the arm stands where forward kinematics had the tool at that time.
    const bar = await page.locator('#timeline input[type=range]').boundingBox();
    await page.mouse.click(bar.x + 0.75 * bar.width, bar.y + bar.height / 2);
    await until(async () => {
      const {at, span, shown} = await of(page);
      return Math.abs(at / span - 0.75) < 0.05 && Math.abs(shown - at) < 0.2;
    }, 'the place that was asked for');
    await until(async () => {
      const [drawn, told] = [(await links(page)).tool, await app(page, () => armature.hub.at('/dental_lamp/tool_pose', armature.playhead.t)?.pose.position)];
      return drawn && told && ['x', 'y', 'z'].every((axis, i) => Math.abs(drawn[i] - told[axis]) < 2e-3);
    }, 'the arm to be drawn where it was');
    assert.match(await page.locator('.when').textContent(), /^0:\d\d\.\d of 0:\d\d\.\d$/);
    assert.ok(await page.locator('#timeline .scale span').count() > 2, 'times below the bar');
    await page.keyboard.press('>');
    await until(async () => (await of(tablet)).speed === 2, 'the speed to be told to the other page');
    await until(async () => (await tablet.locator('select.speed').inputValue()) === '2', 'the speed to stand there');
    await page.locator('select.speed').selectOption('4');
    await until(async () => (await of(tablet)).speed === 4, 'the speed of the list');
    // By finger: what is pressed is large enough, and End and Home are those of the recording.
    for (const one of ['.play', 'select.speed', 'input[type=range]']) {
      const {height} = await tablet.locator(`#timeline ${one}`).boundingBox();
      assert.ok(height >= 44, `${one} is ${height} pixels high`);
    }
    await page.keyboard.press('End');
    await until(async () => Math.abs((await of(tablet)).at - (await of(tablet)).span) < 1e-3, 'the end');
    await tablet.locator('#timeline .play').tap();
    await until(async () => (await of(page)).isPlaying && (await of(page)).at < 5, 'it to begin again');
    await page.keyboard.press('Home');
    assert.ok(await page.locator('button.live').isHidden(), 'nothing is live');
    if (process.env.PICTURES) {
      await sleep(1.5);
      await page.screenshot({path: join(process.env.PICTURES, 'playback.png')});
      await tablet.screenshot({path: join(process.env.PICTURES, 'playback_tablet.png')});
    }
    assert.deepEqual([...page.problems, ...tablet.problems], []);
  } finally {
    await rm(folder, {recursive: true});
  }
}

/// The page that a run in two processes writes into the folder of its report, though nobody recorded the
/// run: the arm moves in it, pictures come as JPEG, all components of both are there, and the figures are
/// those that the run told.
async function ownReport(domain) {
  const folder = await mkdtemp(join(tmpdir(), 'armature-page-'));
  try {
    const apart = ['landmarks', 'face'].flatMap((name) => ['--set', `components.${name}.process=vision`]);
    const figures = JSON.parse(await output(['run', 'dental_lamp', ...apart, '--json', '--report', folder, '--domain', String(domain)]));
    const page = await openPage(pathToFileURL(join(folder, 'report.html')).href);
    await until(() => app(page, () => armature.hub.condition === 'read' && armature.scene.robots.count === 1), 'the arm of the report');
    await page.keyboard.press('Space');
    await page.keyboard.press('Home');
    const tool = async () => {
      await until(() => app(page, () => armature.images.every(({pictures}) => pictures > 0)), 'its pictures');
      return (await links(page)).tool;
    };
    const first = await tool();
    await page.keyboard.press('End');
    await until(async () => {
      const now = await tool();
      return Math.hypot(...now.map((x, i) => x - first[i])) > 0.1;
    }, 'the arm to be elsewhere at the end [m]');
    const topics = await app(page, () => Object.fromEntries([...armature.hub.topics.values()].map(({name, type}) => [name, type])));
    for (const side of ['left', 'right']) {
      assert.equal(topics[`/dental_lamp/${side}/image_raw/compressed`], 'sensor_msgs/msg/CompressedImage');
      assert.ok(!topics[`/dental_lamp/${side}/image_raw`], 'no picture is raw');
    }
    await until(() => app(page, () => armature.hub.recording.hasEnd), 'all of it to be read');
    const [there, told] = await app(page, () => [armature.deployment.components.map(({name}) => name), [...armature.deployment.conditionsAt(armature.playhead.t).keys()]]);
    assert.deepEqual(told.sort(), there.sort(), 'every component of both processes is told of, by a name of its own');
    assert.ok(there.includes('runtime') && there.includes('runtime@vision'));
    await page.getByRole('button', {name: 'About this run'}).click();
    const about = page.locator('dialog.about');
    await until(() => about.getByText(`Figures of the run: ${figures.status}`).count(), 'the figures of the run');
    const row = await about.locator('tr', {hasText: 'mouth position error [mm]'}).textContent();
    assert.equal(row, `mouth position error [mm]${figures.mouth_position_error_mm.toFixed(3)}2.5✓ met`);
    assert.ok(await about.getByText('Timing of the run').count());
    assert.ok(await about.locator('tr', {hasText: 'motion.planner'}).count());
    assert.deepEqual(page.problems, []);
  } finally {
    await rm(folder, {recursive: true});
  }
}

/// A report is opened from the disk, without a server: it shows its run with as many messages as were
/// recorded of a topic that is not thinned, says where it came from, and has nothing that is live.
async function report(domain) {
  const folder = await mkdtemp(join(tmpdir(), 'armature-page-'));
  try {
    const deployment = run(domain, kLampArm);
    const file = join(folder, 'run.mcap'), out = join(folder, 'report.html');
    const {head} = JSON.parse(await output(['record', '-o', file, '--timeout', '12', '--json', '--domain', String(domain)]));
    await deployment.end();
    await output(['report', file, '-o', out]);
    const recorded = Object.fromEntries(JSON.parse(await output(['info', file, '--json'])).topics.map(({topic, messages}) => [topic, messages]));
    await rm(file);
    const page = await openPage('about:blank');
    const requests = [];
    page.on('request', (request) => requests.push(request.url()));
    await page.goto(pathToFileURL(out).href);
    await until(() => app(page, () => armature.hub.condition === 'read' && armature.scene.robots.count === 1), 'the arm of the report');
    await page.keyboard.press('Space');
    await page.keyboard.press('End');
    await until(() => app(page, () => armature.images.length === 2 && armature.images.every(({pictures}) => pictures > 0)), 'its pictures');
    const shown = await app(page, () => Object.fromEntries([...armature.hub.topics.values()].map(({name, count}) => [name, count])));
    for (const topic of ['/dental_lamp/target', '/dental_lamp/task/state', '/rosout', '/tf']) assert.equal(shown[topic], recorded[topic], topic);
    assert.equal(await app(page, () => armature.hub.log('/dental_lamp/task/state').length), recorded['/dental_lamp/task/state'], 'messages that are read');
    const js = '/dental_lamp/arm/measured_js';
    assert.ok(shown[js] > 0 && shown[js] <= recorded[js], `${shown[js]} of ${recorded[js]} messages of ${js}`);
    assert.ok(!shown['/dental_lamp/left/image_raw'], 'no picture comes raw where there is a JPEG');
    // The arm stands where the recording has it, at its end and at its beginning.
    const tool = async () => [(await links(page)).tool, await app(page, () => armature.hub.at('/dental_lamp/tool_pose', armature.playhead.t)?.pose.position)];
    await sleep(1);
    const [drawn, told] = await tool();
    ['x', 'y', 'z'].forEach((axis, i) => near(drawn[i], told[axis], 2e-3, `tool ${axis} [m]`));
    assert.ok((await page.locator('.scene canvas').screenshot()).length > 8000, 'the picture of the arm is not empty');
    assert.equal(await page.locator('button.live').count(), 0);
    assert.equal(await page.locator('#open').count(), 0);
    await until(() => app(page, () => armature.hub.recording.hasEnd), 'all of it to be read');
    await page.getByRole('button', {name: 'About this run'}).click();
    const about = page.locator('dialog.about');
    assert.ok((await about.locator('tr', {hasText: 'Last hash'}).textContent()).endsWith(head));
    for (const text of ['run.mcap', 'whole and unchanged', 'Figures at the end', 'Timing at the end', 'landmarks/dlib68', 'rate_hz']) {
      assert.ok(await about.getByText(text).count(), `${text} in the report`);
    }
    assert.deepEqual(requests.filter((url) => !/^(file|data|blob):/.test(url)), [], 'nothing comes from elsewhere');
    assert.deepEqual(page.problems, []);
  } finally {
    await rm(folder, {recursive: true});
  }
}

/// Two deployments on one domain: the page shows one, and lets choose.
async function two(domain) {
  const server = await monitor(domain);
  run(domain, kLampArm);
  run(domain, ['master_manipulator', '--set', 'clock=system']);
  const page = await openPage(server.url);
  const chooser = page.locator('#header select');
  await until(async () => (await chooser.locator('option').allTextContents()).length === 2, 'both deployments');
  assert.deepEqual(await chooser.locator('option').allTextContents(), ['dental_lamp', 'master_manipulator']);
  for (const [name, component] of [['master_manipulator', 'surgeon'], ['dental_lamp', 'landmarks']]) {
    await chooser.selectOption(`/${name}`);
    await until(() => app(page, (one) => armature.deployment?.components.some(({name: other}) => other === one), component), `${component} of ${name}`);
    await until(() => page.locator(`.graph .node[data-component="${component}"]`).count(), 'its graph');
  }
  assert.deepEqual(page.problems, []);
}

/// Messages that make no sense break nothing, and what is missing is named.
async function nonsense() {
  const server = await fakeServer();
  const page = await openPage('about:blank');
  await page.goto(`${process.env.PAGE_URL}?ws=${encodeURIComponent(server.url)}`);
  await until(() => app(page, () => armature.hub.received > 50), 'the messages');
  await sleep(1);
  assert.match(await page.locator('.scene .note').textContent(), /No arm can be drawn/);
  const logs = await app(page, () => Object.fromEntries(['/odd', '/broken'].map((topic) => {
    armature.hub.log(topic);
    return [topic, String(armature.hub.log(topic).decode)];
  })));
  assert.match(logs['/odd'], /'protobuf', not CDR/);
  assert.match(logs['/broken'], /its type cannot be read/);
  // One that is cut off is named, and those behind it are read.
  await page.evaluate(() => armature.plots[0].shown[1].curve.update(armature.hub));
  await until(() => page.locator('.log').getByText('a message of /joint_states cannot be read').count(), 'the message that was cut off to be named');
  assert.ok(await app(page, () => armature.plots[0].shown[1].curve.values.filter((value) => value === 1).length > 20), 'the others are shown');
  assert.deepEqual(page.problems, []);
  server.close();
}

/// The official client decodes every message of the live deployment.
async function clients(domain) {
  const server = await monitor(domain);
  run(domain, kLampArm);
  await until(async () => (await output(['topic', 'list', '--domain', String(domain)]).catch(() => '')).includes('/tf_static'), 'the topics');
  const told = await decodeLive(server.socket, 6);
  assert.ok(told.topics > 25, `${told.topics} topics`);
  assert.equal(told.failures.length, 0, told.failures.join('\n'));
  console.log(`${told.messages} messages of ${told.topics} topics were decoded`);
}

/// Ten clients that read nothing slow nobody.
async function lazy(domain) {
  const server = await monitor(domain);
  run(domain, kLampArm);
  await until(async () => (await output(['topic', 'list', '--domain', String(domain)]).catch(() => '')).includes('/tf_static'), 'the topics');
  await sleep(5);  // until the pictures flow
  const alone = await decodeLive(server.socket, 5);
  const sockets = await lazyClients(server.socket, 10);
  await sleep(3);
  const among = await decodeLive(server.socket, 5);
  for (const socket of sockets) socket.terminate();
  console.log(`pictures in 5 s: ${alone.pictures} alone, ${among.pictures} beside ten clients that read nothing; messages ${alone.messages}, ${among.messages}`);
  assert.ok(among.pictures > 0.8 * alone.pictures, `${among.pictures} of ${alone.pictures} pictures`);
  assert.equal(among.failures.length, 0, among.failures.join('\n'));
}

/// First data, how long a frame takes, and how many pictures come in a second: figures of this machine.
async function figures(domain) {
  const {page} = await lampPage(domain);
  await until(() => app(page, () => armature.images.length === 2 && armature.images[0].pictures > 20), 'pictures');
  await page.reload();
  await until(() => app(page, () => armature.images.length === 2 && armature.images[0].pictures > 50), 'pictures');
  const told = await app(page, () => ({
    first: armature.hub.firstDataMs / 1000, frame: armature.frameMs,
    scene: armature.scene.frameTimes.reduce((a, b) => a + b, 0) / armature.scene.frameTimes.length,
    rates: armature.images.map(({rateHz}) => rateHz), bytes: armature.hub.store.bytes(),
  }));
  console.log(`first data after ${told.first.toFixed(2)} s; a frame takes ${told.frame.toFixed(1)} ms, the arm in it ${told.scene.toFixed(1)} ms; pictures ${told.rates.map((hz) => hz.toFixed(1)).join(' and ')} Hz; ${(told.bytes / 1e6).toFixed(1)} MB are remembered`);
  assert.ok(told.first < 2, `first data after ${told.first} s`);
}

/// Pairs of pictures in a second that the server delivers to one client, of cameras at 30 Hz.
async function pairs(domain) {
  const server = await monitor(domain);
  run(domain, [...kLampArm, '--set', 'components.scene.params.rate_hz=30']);
  await until(async () => (await output(['topic', 'list', '--domain', String(domain)]).catch(() => '')).includes('right/image_raw/compressed'), 'the topics');
  await sleep(10);
  const told = await decodeLive(server.socket, 10, (topic) => /image_raw\/compressed$/.test(topic));
  const written = await output(['topic', 'hz', '/dental_lamp/left/camera_info', '-n', '2', '--timeout', '1', '--domain', String(domain)]).catch(() => '');
  console.log(`${(told.pictures / 20).toFixed(1)} pairs of pictures a second ${written}`);
}

/// No panel lies on another, nothing is cut off, at the sizes of a laptop and of a tablet.
async function sizes(domain) {
  const {page} = await lampPage(domain);
  for (const size of [{width: 1366, height: 768}, {width: 1024, height: 768}, {width: 768, height: 1024}, {width: 1920, height: 1080}]) {
    await page.setViewportSize(size);
    await sleep(0.7);
    const told = await page.evaluate(() => ({
      scrolls: document.documentElement.scrollHeight > innerHeight || document.documentElement.scrollWidth > innerWidth,
      panels: [...document.querySelectorAll('.panel, #header > *, #timeline > :not(.visually-hidden)')].flatMap((one) => {
        const {left, top, right, bottom, width} = one.getBoundingClientRect();
        return width > 0 ? [{name: one.getAttribute('aria-label') ?? one.className, isPanel: one.matches('.panel'), left, top, right, bottom}] : [];
      }),
      task: [document.querySelector('.doing').scrollWidth, document.querySelector('.doing').clientWidth],
    }));
    assert.ok(told.task[0] <= told.task[1], `what it does has ${told.task[1]} of ${told.task[0]} pixels at ${size.width} x ${size.height}`);
    assert.ok(!told.scrolls, `${size.width} x ${size.height} scrolls`);
    for (const [i, a] of told.panels.entries()) {
      assert.ok(a.left >= 0 && a.top >= 0 && a.right <= size.width && a.bottom <= size.height, `${a.name} is inside ${size.width} x ${size.height}`);
      assert.ok(!a.isPanel || (a.right - a.left > 100 && a.bottom - a.top > 30), `${a.name} has room`);
      for (const b of told.panels.slice(i + 1)) {
        assert.ok(a.right <= b.left + 1 || b.right <= a.left + 1 || a.bottom <= b.top + 1 || b.bottom <= a.top + 1, `${a.name} lies on ${b.name}`);
      }
    }
  }
  // All that can be pressed has a name, and is reached by the keyboard.
  const nameless = await page.evaluate(() => [...document.querySelectorAll('button, input, select, [role=button]')].filter((one) =>
    !(one.getAttribute('aria-label') || one.textContent.trim() || one.title || one.labels?.length)).map((one) => one.outerHTML));
  assert.deepEqual(nameless, []);
  await page.keyboard.press('?');
  assert.ok(await page.locator('dialog.help').isVisible());
  await page.keyboard.press('Escape');
  for (const key of ['1', '1', '2', 'Escape', 'Home', 'End']) await page.keyboard.press(key);
  assert.deepEqual(page.problems, []);
}

export const scenarios = {arm, pictures, plots, graph, scrub, again, recording, playback, report, ownReport, two, nonsense, clients, lazy, figures, pairs, sizes};
