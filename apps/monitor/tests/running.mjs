// SPDX-License-Identifier: Apache-2.0
// Starts what a test looks at: deployments, the monitor, the browser. All of it ends with the test.
import {spawn, execFile} from 'node:child_process';
import {promisify} from 'node:util';
import {chromium} from 'playwright-core';

export const armature = process.env.ARMATURE ?? 'armature';
export const kPatienceMs = 90_000;
const programs = new Set();

export class Program {
  constructor(words) {
    this.out = '';
    this.err = '';
    this.words = words;
    this.process = spawn(armature, words, {stdio: ['ignore', 'pipe', 'pipe']});
    this.process.stdout.on('data', (text) => (this.out += text));
    this.process.stderr.on('data', (text) => (this.err += text));
    this.ended = new Promise((resolve) => this.process.on('exit', resolve));
    programs.add(this);
  }
  async tells(pattern) {
    return until(() => pattern.exec(this.out), `${this.words.join(' ')} to tell ${pattern}; it told: ${this.out}${this.err}`);
  }
  async end(signal = 'SIGINT') {
    this.process.kill(signal);
    await this.ended;
    programs.delete(this);
  }
}

export function run(domain, words) { return new Program(['run', ...words, '--keep-running', '--domain', String(domain)]); }

export async function monitor(domain, port = 0) {
  const program = new Program(['monitor', '--domain', String(domain), '--port', String(port)]);
  const [, place] = await program.tells(/http:\/\/([\d.]+:\d+)\//);
  return Object.assign(program, {url: `http://${place}/`, socket: `ws://${place}`, port: Number(place.split(':')[1])});
}

/// A recording that is played to browsers.
export async function played(file) {
  const program = new Program(['replay', file, '--monitor', '--port', '0']);
  const [, place] = await program.tells(/http:\/\/([\d.]+:\d+)\//);
  return Object.assign(program, {url: `http://${place}/`});
}

/// The output of a command of armature that ends.
export async function output(words) {
  const {stdout} = await promisify(execFile)(armature, words, {maxBuffer: 1 << 28});
  return stdout;
}
/// One sample of a topic, as JSON.
export async function sample(domain, topic) {
  return JSON.parse((await output(['topic', 'echo', topic, '-n', '1', '--timeout', '30', '--domain', String(domain)])).replace(/\n---\s*$/, ''));
}

let browser;
/// A page in Debian's Chromium. Whatever it throws makes the test fail.
export async function openPage(url, size = {width: 1366, height: 768}, hasTouch = false) {
  browser ??= await chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-gpu-compositing'],
  });
  const page = await browser.newPage({viewport: size, hasTouch, isMobile: hasTouch});
  page.problems = [];
  page.on('pageerror', (error) => page.problems.push(error.stack));
  page.on('console', (message) => {
    // A socket that nobody answers is told on the console, too; the page tells it by itself.
    if (message.type() === 'error' && !/WebSocket connection/.test(message.text())) page.problems.push(message.text());
  });
  await page.goto(url);
  return page;
}

/// The first value of `look` that is not false.
export async function until(look, what, patience = kPatienceMs) {
  const end = Date.now() + patience;
  for (;;) {
    const value = await look();
    if (value) return value;
    if (Date.now() > end) throw new Error(`waited in vain for ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}
export const sleep = (seconds) => new Promise((resolve) => setTimeout(resolve, 1000 * seconds));

export async function endAll() {
  await browser?.close();
  for (const program of programs) program.process.kill('SIGKILL');
}
