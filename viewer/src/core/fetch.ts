import { LoadError } from './load_error';
import { text } from './text';

/** Called as bytes arrive: how many since the last call. */
export type OnBytes = (count: number) => void;

/**
 * The bytes of a file, streamed so that progress can be shown.
 * @param expectedBytes size by the manifest, or null when unknown; another size means a damaged copy and is refused
 * @throws LoadError with the address when the file is missing, unreachable or of another size
 */
export function fetchBytes(url: string, expectedBytes: number | null, onBytes: OnBytes, signal?: AbortSignal): Promise<Uint8Array<ArrayBuffer>> {
  return fetchStart(url, expectedBytes, onBytes, () => null, signal);
}

/**
 * The first bytes of a file, as many as `needed` says once it can tell from what has come; null: all, or it cannot tell yet. The connection is dropped then.
 * As fetchBytes() else.
 */
export async function fetchStart(
  url: string, expectedBytes: number | null, onBytes: OnBytes, needed: (soFar: readonly Uint8Array[]) => number | null, signal?: AbortSignal,
): Promise<Uint8Array<ArrayBuffer>> {
  let response: Response;
  try {
    response = await fetch(url, signal ? { signal } : {});
  } catch (error) {
    if (signal?.aborted) throw error;
    throw new LoadError(url, text.error.unreachable);
  }
  if (!response.ok) throw new LoadError(url, text.error.missing(response.status));
  const chunks: Uint8Array[] = [];
  let size = 0;
  let enough: number | null = null;
  try {
    if (response.body) {
      const reader = response.body.getReader();
      for (;;) {
        const { done, value } = await reader.read();
        if (done) break;
        chunks.push(value);
        size += value.byteLength;
        onBytes(value.byteLength);
        enough ??= needed(chunks);
        if (enough !== null && size >= enough) {
          await reader.cancel();
          break;
        }
      }
    }
  } catch (error) {
    if (signal?.aborted) throw error;
    throw new LoadError(url, text.error.unreachable);
  }
  const isWhole = enough === null || size < enough;
  if (isWhole && expectedBytes !== null && size !== expectedBytes) throw new LoadError(url, text.error.truncated(size, expectedBytes));
  const bytes = new Uint8Array(size);
  let offset = 0;
  for (const chunk of chunks) {
    bytes.set(chunk, offset);
    offset += chunk.byteLength;
  }
  return bytes;
}

/**
 * A part of a file, for hosts that answer ranges; from others the whole file comes, and the part is cut out of it.
 * @returns bytes [first, first + count), fewer where the file ends
 * @throws LoadError with the address when the file is missing or unreachable
 */
export async function fetchRange(url: string, first: number, count: number): Promise<{ bytes: Uint8Array<ArrayBuffer>; whole: Uint8Array<ArrayBuffer> | null }> {
  let response: Response;
  let bytes: Uint8Array<ArrayBuffer>;
  try {
    response = await fetch(url, { headers: { range: `bytes=${first}-${first + count - 1}` } });
    bytes = new Uint8Array(await response.arrayBuffer());
  } catch {
    throw new LoadError(url, text.error.unreachable);
  }
  if (!response.ok) throw new LoadError(url, text.error.missing(response.status));
  if (response.status === 206) return { bytes, whole: null };
  return { bytes: bytes.slice(first, first + count), whole: bytes };
}
