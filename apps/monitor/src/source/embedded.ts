// SPDX-License-Identifier: Apache-2.0
// The recording that `armature report` puts into the page, in base64.

/// What the run told at its end, as the file figures.json in its recording has it.
export interface RunFigures {
  status: string;
  reasons: string[];
  figures: {title: string; value: number | string | (number | null)[] | null; goal?: number; met?: boolean; not_measured?: string; does_not_apply?: string}[];
  timing: {executors: Record<string, Record<string, Timing>>; components: Record<string, Record<string, Timing>>};
}
export interface Timing { count: number; mean_s: number; p99_s: number; max_s: number }

export interface Embedded {
  file: File;
  told: [name: string, text: string][];  // where it came from
  figures: RunFigures | undefined;       // nothing: the recording has none
}

const kPart = 4 << 20;  // [digit], a multiple of four

/// Nothing: this is the page of `armature monitor`.
export function embeddedRecording(): Embedded | undefined {
  const element = document.getElementById('recording');
  if (!element) return undefined;
  const text = element.textContent ?? '';
  const parts: BlobPart[] = [];
  for (let at = 0; at < text.length; at += kPart) {
    parts.push(Uint8Array.from(atob(text.slice(at, at + kPart)), (digit) => digit.charCodeAt(0)));
  }
  element.textContent = '';  // its memory is wanted for other things
  return {
    file: new File(parts, element.dataset.name ?? 'recording'),
    told: JSON.parse(element.dataset.told ?? '[]'),
    figures: figuresOf(element.dataset.figures ?? ''),
  };
}

/// A recording of somebody else may have another file of that name.
function figuresOf(text: string): RunFigures | undefined {
  try {
    const told = JSON.parse(text);
    return Array.isArray(told.figures) && Array.isArray(told.reasons) && told.timing?.components ? told : undefined;
  } catch {
    return undefined;
  }
}
