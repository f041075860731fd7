// What of a binary glTF has to come over the wire.

/** As far as glTF 2.0 is read here. */
interface GltfDef {
  accessors?: { bufferView?: number }[];
  bufferViews?: { byteOffset?: number; byteLength: number }[];
  images?: { bufferView?: number }[];
  textures?: { source?: number }[];
  materials?: { pbrMetallicRoughness?: { baseColorTexture?: { index: number } } }[];
  meshes?: { primitives: { indices?: number; attributes: Record<string, number> }[] }[];
}

const header = 12;
const chunkHeader = 8;

/**
 * How many of the first bytes of a GLB hold its JSON, and the attributes and base colour textures that are read; null while its JSON is not
 * whole, or when it is none: who parses it says so better.
 * @param soFar the file's first bytes, in pieces
 */
export function bytesNeededOfGlb(soFar: readonly Uint8Array[], attributes: readonly string[]): number | null {
  const size = soFar.reduce((sum, { byteLength }) => sum + byteLength, 0);
  const start = join(soFar, header + chunkHeader);
  if (start.byteLength < header + chunkHeader) return null;
  const jsonSize = new DataView(start.buffer).getUint32(header, true);
  const jsonEnd = header + chunkHeader + jsonSize;
  if (size < jsonEnd) return null;
  let gltf: GltfDef;
  try {
    gltf = JSON.parse(new TextDecoder().decode(join(soFar, jsonEnd).subarray(header + chunkHeader))) as GltfDef;
  } catch {
    return null;
  }
  const primitives = (gltf.meshes ?? []).flatMap((mesh) => mesh.primitives);
  const accessors = primitives.flatMap(({ indices, attributes: own }) => [indices, ...attributes.map((name) => own[name])]);
  const images = (gltf.materials ?? []).map(({ pbrMetallicRoughness: pbr }) => gltf.textures?.[pbr?.baseColorTexture?.index ?? -1]?.source);
  const views = [...accessors.map((index) => gltf.accessors?.[index ?? -1]?.bufferView), ...images.map((index) => gltf.images?.[index ?? -1]?.bufferView)];
  const ends = [...new Set(views)].map((index) => {
    const view = gltf.bufferViews?.[index ?? -1];
    return view ? (view.byteOffset ?? 0) + view.byteLength : 0;
  });
  return jsonEnd + chunkHeader + Math.max(0, ...ends);
}

function join(pieces: readonly Uint8Array[], count: number): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(count);
  let offset = 0;
  for (const piece of pieces) {
    if (offset >= count) break;
    bytes.set(piece.subarray(0, count - offset), offset);
    offset += piece.byteLength;
  }
  return bytes.subarray(0, Math.min(offset, count));
}

/** Makes the first bytes of a GLB a GLB of their own: its lengths say what is there. Changes the bytes. */
export function closeGlb(bytes: Uint8Array<ArrayBuffer>): void {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.byteLength < header + chunkHeader || bytes.byteLength >= view.getUint32(8, true)) return;
  const binary = header + chunkHeader + view.getUint32(header, true);
  if (bytes.byteLength < binary + chunkHeader) return;
  view.setUint32(8, bytes.byteLength, true);
  view.setUint32(binary, bytes.byteLength - binary - chunkHeader, true);
}
