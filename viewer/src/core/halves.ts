import { LoadError } from './load_error';
import { text } from './text';

/** `count` little-endian half floats, as bits. Throws LoadError when there are more or fewer. */
export function parseHalves(url: string, bytes: Uint8Array<ArrayBuffer>, count: number): Uint16Array<ArrayBuffer> {
  if (bytes.byteLength !== 2 * count) throw new LoadError(url, text.error.size(bytes.byteLength, 2 * count));
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const halves = new Uint16Array(count);
  for (let i = 0; i < count; ++i) halves[i] = view.getUint16(2 * i, true);
  return halves;
}
