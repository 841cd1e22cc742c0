// SPDX-License-Identifier: Apache-2.0
import {make} from '../view';

const kKeys: [string, string][] = [
  ['Space', 'pause, and go on'],
  ['← →', 'a second back or on; with Shift a tenth'],
  ['Home, End', 'to the beginning; to now, or to the end of a recording'],
  ['< >', 'a recording slower, faster'],
  ['1 … 9', 'this panel alone, and all again'],
  ['Esc', 'all panels again; close what is open'],
  ['F S T V', 'in the picture of the arm: front, side, top, as at first'],
  ['Tab, Enter', 'to a component, and what it consists of'],
  ['O', 'open a recording'],
  ['?', 'this help'],
];

export function helpDialog(): HTMLDialogElement {
  const close = make('button', {type: 'button', class: 'close', 'aria-label': 'Close'}, '✕');
  const dialog = make('dialog', {class: 'help', 'aria-label': 'Keys'},
      make('header', {}, make('h2', {}, 'Keys'), close),
      make('dl', {}, ...kKeys.flatMap(([key, what]) => [make('dt', {}, make('kbd', {}, key)), make('dd', {}, what)])),
      make('p', {}, 'A recording (MCAP) can be dropped onto the page, too. States are told by sign, word and colour: ● ok, ▲ degraded, ✖ fault, ◼ stalled.'));
  close.addEventListener('click', () => dialog.close());
  document.body.append(dialog);
  return dialog;
}
