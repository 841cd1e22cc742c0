// SPDX-License-Identifier: Apache-2.0
// Times of a recording as people write them, and where they stand below its bar.

const kSteps = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400];  // [s]
const kMarkPx = 56;  // of a bar for each time below it, at least

/// "0:07.5", "12:30.0", "1:02:03.4", without the tenths where `digits` is 0.
export function clock(seconds: number, digits = 1): string {
  const scale = 10 ** digits, all = Math.round(Math.max(0, seconds) * scale) / scale;
  const hours = Math.floor(all / 3600), minutes = Math.floor((all - 3600 * hours) / 60);
  const rest = (all - 3600 * hours - 60 * minutes).toFixed(digits).padStart(digits > 0 ? 3 + digits : 2, '0');
  return hours > 0 ? `${hours}:${String(minutes).padStart(2, '0')}:${rest}` : `${minutes}:${rest}`;
}

/// The times [s] that are written below a bar of `span` seconds: whole steps of at least a second, as many
/// as there is room for.
export function marksOf(span: number, widthPx: number): number[] {
  const most = Math.floor(widthPx / kMarkPx);
  if (!(span > 0) || most < 1) return [];
  const step = kSteps.find((one) => span / one <= most) ?? 3600 * Math.ceil(span / most / 3600);
  return Array.from({length: Math.floor(span / step) + 1}, (_, i) => i * step);
}
