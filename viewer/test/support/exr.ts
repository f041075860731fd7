// An EXR writer of its own, for files of known numbers: scan lines of 32-bit channels, ZIP or uncompressed.
import { deflateSync } from 'node:zlib';

export interface ExrChannelData {
  name: string;
  isInteger?: boolean;
  value(column: number, row: number): number;
}

export function encodeExr(width: number, height: number, channels: readonly ExrChannelData[], compression: 'zip' | 'none' = 'zip'): Buffer {
  const sorted = [...channels].sort((a, b) => (a.name < b.name ? -1 : 1));
  const int = (...values: number[]): Buffer => Buffer.from(new Int32Array(values).buffer);
  const float = (...values: number[]): Buffer => Buffer.from(new Float32Array(values).buffer);
  const attribute = (name: string, type: string, data: Buffer): Buffer => Buffer.concat([Buffer.from(`${name}\0${type}\0`), int(data.length), data]);
  const list = Buffer.concat([...sorted.map(({ name, isInteger }) => Buffer.concat([Buffer.from(`${name}\0`), int(isInteger ? 0 : 2, 0, 1, 1)])), Buffer.from([0])]);
  const window = int(0, 0, width - 1, height - 1);
  const header = Buffer.concat([
    int(20000630, 2),
    attribute('channels', 'chlist', list),
    attribute('compression', 'compression', Buffer.from([compression === 'zip' ? 3 : 0])),
    attribute('dataWindow', 'box2i', window),
    attribute('displayWindow', 'box2i', window),
    attribute('lineOrder', 'lineOrder', Buffer.from([0])),
    attribute('pixelAspectRatio', 'float', float(1)),
    attribute('screenWindowCenter', 'v2f', float(0, 0)),
    attribute('screenWindowWidth', 'float', float(1)),
    Buffer.from([0]),
  ]);
  const lines = compression === 'zip' ? 16 : 1;
  const chunks: Buffer[] = [];
  for (let first = 0; first < height; first += lines) {
    const rows: Buffer[] = [];
    for (let row = first; row < Math.min(height, first + lines); ++row) {
      for (const { isInteger, value } of sorted) {
        const numbers = Array.from({ length: width }, (_, column) => value(column, row));
        rows.push(Buffer.from(isInteger ? new Uint32Array(numbers).buffer : new Float32Array(numbers).buffer));
      }
    }
    const raw = Buffer.concat(rows);
    const packed = compression === 'zip' ? zip(raw) : raw;
    const data = packed.length < raw.length ? packed : raw;
    chunks.push(Buffer.concat([int(first, data.length), data]));
  }
  const table = Buffer.alloc(8 * chunks.length);
  let at = header.length + table.length;
  chunks.forEach((chunk, i) => {
    table.writeBigUInt64LE(BigInt(at), 8 * i);
    at += chunk.length;
  });
  return Buffer.concat([header, table, ...chunks]);
}

function zip(raw: Buffer): Buffer {
  const parted = Buffer.concat([raw.filter((_, i) => i % 2 === 0), raw.filter((_, i) => i % 2 === 1)]);
  const differences = Buffer.from(parted.map((byte, i) => (i === 0 ? byte : byte - (parted[i - 1] ?? 0) + 128)));
  return deflateSync(differences);
}
