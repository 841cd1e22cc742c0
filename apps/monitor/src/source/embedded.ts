// SPDX-License-Identifier: Apache-2.0
// The recording that `armature report` puts into the page, in base64.

export interface Embedded {
  file: File;
  told: [name: string, text: string][];  // where it came from
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
  };
}
