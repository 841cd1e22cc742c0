// SPDX-License-Identifier: Apache-2.0
import type {Message} from '../message/decoder';

/// The pixels of a sensor_msgs/Image, or why they cannot be shown.
export function rawPixels(message: Message): ImageData | string {
  const {width, height, encoding, step} = message as {width: number; height: number; encoding: string; step: number};
  const data = message.data as Uint8Array;
  const bytes = {mono8: 1, '8UC1': 1, rgb8: 3, bgr8: 3, '8UC3': 3, rgba8: 4, bgra8: 4, mono16: 2, '16UC1': 2}[encoding];
  if (!bytes) return `Pictures of the encoding '${encoding}' are not shown here`;
  if (width * height === 0 || step < width * bytes || data.length < step * height) return 'A picture is shorter than it says';
  const image = new ImageData(width, height), out = image.data;
  const [r, g, b] = encoding.startsWith('bgr') || encoding === '8UC3' ? [2, 1, 0] : [0, 1, 2];
  for (let y = 0, o = 0; y < height; ++y) {
    for (let x = 0, i = y * step; x < width; ++x, i += bytes, o += 4) {
      if (bytes >= 3) {
        out[o] = data[i + r!]!;
        out[o + 1] = data[i + g!]!;
        out[o + 2] = data[i + b!]!;
      } else {
        out[o] = out[o + 1] = out[o + 2] = bytes === 1 ? data[i]! : data[i + (message.is_bigendian ? 0 : 1)]!;
      }
      out[o + 3] = 255;
    }
  }
  return image;
}
