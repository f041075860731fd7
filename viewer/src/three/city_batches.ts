import * as THREE from 'three';
import { makePictureLayers, type LayerPainter } from './layers';

/** One primitive of city.glb: its surfaces share a texture and lie in one lightmap page. */
export interface CityPart {
  geometry: THREE.BufferGeometry;
  matrixWorld: THREE.Matrix4;
  /** Of the lightmap, and its size in texels. */
  page: number;
  pageSize: { width: number; height: number };
  map: THREE.Texture | null;
  /** Linear; the alpha is weighed so that what is below one half of the product with the texture's is cut out. */
  tint: THREE.Vector4;
  isCutOut: boolean;
  isDoubleSided: boolean;
}

/** Parts that are drawn at once: their textures are layers of one. */
export interface Batch {
  geometry: THREE.BufferGeometry;
  /** Null: surfaces without textures. */
  layers: THREE.WebGLArrayRenderTarget | null;
  maps: readonly THREE.Texture[];
  isCutOut: boolean;
  isDoubleSided: boolean;
}

/** With more sizes of textures than this, all are brought to powers of two. */
const mostSizes = 8;
/** WebGL 2 promises so many (MAX_ARRAY_TEXTURE_LAYERS). */
const mostLayers = 256;

/** Textures that become the layers of one. */
interface MapGroup {
  width: number;
  height: number;
  maps: THREE.Texture[];
}

/** Joins parts into few batches. Their geometries are used up. */
export async function makeBatches(parts: readonly CityPart[], painter: LayerPainter, anisotropy: number): Promise<Batch[]> {
  const maps = new Set(parts.flatMap(({ map }) => (map ? [map] : [])));
  const batches = batchesOf(parts.filter(({ map }) => map === null), [], null);
  for (const group of groupsOf([...maps])) {
    const layers = await paintGroup(group, painter, anisotropy);
    batches.push(...batchesOf(parts.filter(({ map }) => map !== null && group.maps.includes(map)), group.maps, layers));
  }
  for (const { geometry } of parts) geometry.dispose();
  return batches;
}

function batchesOf(parts: readonly CityPart[], maps: readonly THREE.Texture[], layers: THREE.WebGLArrayRenderTarget | null): Batch[] {
  return [false, true].flatMap((isCutOut) => [false, true].flatMap((isDoubleSided) => {
    const alike = parts.filter((part) => part.isCutOut === isCutOut && part.isDoubleSided === isDoubleSided);
    return alike.length > 0 ? [{ geometry: joinParts(alike, maps), layers, maps, isCutOut, isDoubleSided }] : [];
  }));
}

function sizeOf(map: THREE.Texture): { width: number; height: number } {
  return map.image as ImageBitmap;
}

/** Textures of one size and wrapping. A city with many sizes (photographs of its walls) has all brought to the nearest powers of two. */
function groupsOf(maps: readonly THREE.Texture[]): MapGroup[] {
  const areManySizes = new Set(maps.map((map) => `${sizeOf(map).width}|${sizeOf(map).height}`)).size > mostSizes;
  const side = (pixels: number): number => (areManySizes ? 2 ** Math.round(Math.log2(pixels)) : pixels);
  const groups = new Map<string, MapGroup[]>();
  for (const map of maps) {
    const [width, height] = [side(sizeOf(map).width), side(sizeOf(map).height)];
    const key = [width, height, map.wrapS, map.wrapT].join('|');
    const alike = groups.get(key) ?? [];
    groups.set(key, alike);
    if ((alike.at(-1)?.maps.length ?? mostLayers) === mostLayers) alike.push({ width, height, maps: [] });
    alike.at(-1)?.maps.push(map);
  }
  return [...groups.values()].flat();
}

async function paintGroup({ width, height, maps }: MapGroup, painter: LayerPainter, anisotropy: number): Promise<THREE.WebGLArrayRenderTarget> {
  const pictures = await Promise.all(maps.map(({ image }) => {
    const picture = image as ImageBitmap;
    if (picture.width === width && picture.height === height) return picture;
    return createImageBitmap(picture, { resizeWidth: width, resizeHeight: height, resizeQuality: 'high', premultiplyAlpha: 'none', colorSpaceConversion: 'none' });
  }));
  const [wrapS, wrapT] = [maps[0]?.wrapS ?? THREE.RepeatWrapping, maps[0]?.wrapT ?? THREE.RepeatWrapping];
  const layers = makePictureLayers(painter, pictures, [wrapS, wrapT], anisotropy);
  pictures.forEach((picture, k) => picture !== maps[k]?.image && picture.close());
  return layers;
}

/** One indexed geometry of all parts in scene coordinates; `texel` is column, row and page in the lightmap, `layer` the place of a part's texture in `maps`. */
function joinParts(parts: readonly CityPart[], maps: readonly THREE.Texture[]): THREE.BufferGeometry {
  let vertexCount = 0;
  let indexCount = 0;
  for (const { geometry } of parts) {
    const count = geometry.getAttribute('position').count;
    vertexCount += count;
    indexCount += geometry.index?.count ?? count;
  }
  const position = new Float32Array(vertexCount * 3);
  const texel = new Float32Array(vertexCount * 3);
  const chart = new Float32Array(vertexCount);
  const tint = new Float32Array(vertexCount * 4);
  const uv = new Float32Array(maps.length > 0 ? vertexCount * 2 : 0);
  const layer = new Float32Array(maps.length > 0 ? vertexCount : 0);
  const index = new Uint32Array(indexCount);
  const corner = new THREE.Vector3();
  const place = new THREE.Vector2();
  let vertex = 0;
  let slot = 0;
  for (const part of parts) {
    const { geometry, map } = part;
    const [positions, light, charts, pictures] = ['position', 'uv1', '_chart', 'uv'].map((name) => geometry.getAttribute(name));
    if (!positions || !light || !charts) continue; // loadCity() has refused it
    map?.updateMatrix();
    const ownLayer = map ? maps.indexOf(map) : 0;
    for (let i = 0; i < positions.count; ++i) {
      const v = vertex + i;
      corner.fromBufferAttribute(positions, i).applyMatrix4(part.matrixWorld).toArray(position, 3 * v);
      texel.set([light.getX(i) * part.pageSize.width, light.getY(i) * part.pageSize.height, part.page], 3 * v);
      chart[v] = charts.getX(i);
      part.tint.toArray(tint, 4 * v);
      if (!map) continue;
      if (pictures) place.set(pictures.getX(i), pictures.getY(i)).applyMatrix3(map.matrix).toArray(uv, 2 * v);
      layer[v] = ownLayer;
    }
    const count = geometry.index?.count ?? positions.count;
    for (let i = 0; i < count; ++i) index[slot + i] = vertex + (geometry.index ? geometry.index.getX(i) : i);
    vertex += positions.count;
    slot += count;
  }
  const joined = new THREE.BufferGeometry();
  joined.setAttribute('position', new THREE.BufferAttribute(position, 3));
  joined.setAttribute('texel', new THREE.BufferAttribute(texel, 3));
  joined.setAttribute('chart', new THREE.BufferAttribute(chart, 1));
  joined.setAttribute('tint', new THREE.BufferAttribute(tint, 4));
  if (maps.length > 0) {
    joined.setAttribute('uv', new THREE.BufferAttribute(uv, 2));
    joined.setAttribute('layer', new THREE.BufferAttribute(layer, 1));
  }
  joined.setIndex(new THREE.BufferAttribute(index, 1));
  joined.computeBoundingBox();
  joined.computeBoundingSphere();
  return joined;
}
