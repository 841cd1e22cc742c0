// SPDX-License-Identifier: Apache-2.0
import './style.css';
import {App} from './app';
import {embeddedRecording} from './source/embedded';

const query = new URLSearchParams(location.search);

/// Where the messages come from: the server of this page, unless the address says another.
function socketUrl(): string {
  const other = query.get('ws');
  const base = other ?? `${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/`;
  const token = query.get('token');
  return token && !other ? `${base}?token=${encodeURIComponent(token)}` : base;
}

const report = embeddedRecording();
const app = new App(document.getElementById('header')!, document.getElementById('panels')!, document.getElementById('timeline')!, report);
if (report) {
  document.title = `${report.file.name} - Armature`;
  void app.openFile(report.file);
} else {
  app.connect(location.protocol.startsWith('http') || query.has('ws') ? socketUrl() : '');
}
// For those who test the page: what it shows, to be read.
Object.assign(window, {armature: app});
