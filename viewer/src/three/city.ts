import * as THREE from 'three';
import { GLTFLoader, type GLTF, type GLTFLoaderPlugin, type GLTFParser } from 'three/addons/loaders/GLTFLoader.js';
import { LoadError } from '../core/load_error';
import { text } from '../core/text';
import { makeCityMaterial, type PageUniforms, type SharedUniforms, type SurfaceLook } from './city_material';

const lightmapExtension = 'SKYBAKE_lightmap';

interface LitMaterial {
  page: number;
  look: SurfaceLook;
  key: string;
}

/** The city as few meshes: one for each look and lightmap page, in scene coordinates. */
export interface City {
  group: THREE.Group;
  pages: PageUniforms[];
  triangleCount: number;
  /** Primitives of the file, before those of one look and page were joined. */
  primitiveCount: number;
  /** Albedo textures on the graphics card, with their mip levels. */
  textureBytes: number;
  chartCount: number;
  bounds: THREE.Box3;
  dispose(): void;
}

interface MaterialDef {
  occlusionTexture?: unknown;
  normalTexture?: unknown;
  emissiveTexture?: unknown;
  extensions?: Record<string, { page?: unknown } | undefined>;
  pbrMetallicRoughness?: { metallicRoughnessTexture?: unknown };
}

/** Drops what the baked light replaces before GLTFLoader fetches it: the occlusion texture serves viewers that know no lightmap. */
class ForgetReplacedTextures implements GLTFLoaderPlugin {
  readonly name = lightmapExtension;
  constructor(private readonly parser: GLTFParser) {}

  async beforeRoot(): Promise<void> {
    const materials = ((this.parser.json as { materials?: MaterialDef[] }).materials ?? []);
    for (const material of materials) {
      delete material.occlusionTexture;
      delete material.normalTexture;
      delete material.emissiveTexture;
      delete material.pbrMetallicRoughness?.metallicRoughnessTexture;
    }
  }
}

/** Parses city.glb. Throws LoadError when it is no glTF, or when a part of it cannot be lit. */
export async function loadCity(url: string, bytes: Uint8Array<ArrayBuffer>, pageSizes: readonly { width: number; height: number }[], shared: SharedUniforms, maxAnisotropy: number): Promise<City> {
  const loader = new GLTFLoader();
  loader.register((parser) => new ForgetReplacedTextures(parser));
  let gltf: GLTF;
  try {
    gltf = await loader.parseAsync(bytes.buffer, THREE.LoaderUtils.extractUrlBase(url));
  } catch (error) {
    throw new LoadError(url, text.error.notAModel(error instanceof Error ? error.message : String(error)));
  }
  gltf.scene.updateMatrixWorld(true);

  const pages: PageUniforms[] = pageSizes.map((size) => ({
    uSkyPage: { value: null },
    uSunPage: { value: null },
    uIndirectPage: { value: null },
    uSkyPageB: { value: null },
    uSunPageB: { value: null },
    uIndirectPageB: { value: null },
    uMeasurePage: { value: null },
    uLampPage: { value: null },
    uPageSize: { value: new THREE.Vector2(size.width, size.height) },
  }));
  const parts = new Map<string, { lit: LitMaterial; meshes: THREE.Mesh[] }>();
  gltf.scene.traverse((object) => {
    if (!(object instanceof THREE.Mesh)) return;
    const mesh = object as THREE.Mesh<THREE.BufferGeometry, THREE.Material>;
    const lit = readMaterial(url, gltf.parser, mesh, pages.length);
    if (!mesh.geometry.getAttribute('uv1') || !mesh.geometry.getAttribute('_chart')) throw new LoadError(url, text.error.noCoordinates(mesh.name));
    const part = parts.get(lit.key);
    if (part) part.meshes.push(mesh);
    else parts.set(lit.key, { lit, meshes: [mesh] });
  });

  if (parts.size === 0) throw new LoadError(url, text.error.emptyModel);

  const group = new THREE.Group();
  group.matrixAutoUpdate = false;
  const bounds = new THREE.Box3();
  let triangleCount = 0;
  let chartCount = 0;
  for (const { lit, meshes } of parts.values()) {
    const geometry = mergeMeshes(meshes, lit.look);
    for (const mesh of meshes) mesh.geometry.dispose();
    const page = pages[lit.page];
    if (!page) throw new LoadError(url, text.error.noLightmap(lit.look.name));
    if (lit.look.map) lit.look.map.anisotropy = Math.min(8, maxAnisotropy);
    geometry.computeBoundingBox();
    geometry.computeBoundingSphere();
    if (geometry.boundingBox) bounds.union(geometry.boundingBox);
    triangleCount += (geometry.index?.count ?? 0) / 3;
    const charts = geometry.getAttribute('_chart').array;
    for (let i = 0; i < charts.length; ++i) chartCount = Math.max(chartCount, (charts[i] ?? 0) + 1);
    const mesh = new THREE.Mesh(geometry, makeCityMaterial(lit.look, page, shared));
    mesh.name = lit.look.name;
    mesh.userData = { page: lit.page };
    mesh.matrixAutoUpdate = false;
    group.add(mesh);
  }
  const maps = new Set([...parts.values()].flatMap(({ lit }) => (lit.look.map ? [lit.look.map] : [])));
  const sizes = [...maps].map(({ image }) => (image as ImageBitmap).width * (image as ImageBitmap).height);
  return {
    group,
    pages,
    triangleCount,
    primitiveCount: [...parts.values()].reduce((sum, { meshes }) => sum + meshes.length, 0),
    textureBytes: Math.round(((4 * 4) / 3) * sizes.reduce((sum, pixels) => sum + pixels, 0)),
    chartCount,
    bounds,
    dispose() {
      for (const child of group.children) {
        if (!(child instanceof THREE.Mesh)) continue;
        const mesh = child as THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial>;
        mesh.geometry.dispose();
        (mesh.material.uniforms['uMap']?.value as THREE.Texture | null)?.dispose();
        mesh.material.dispose();
      }
    },
  };
}

function readMaterial(url: string, parser: GLTFParser, mesh: THREE.Mesh<THREE.BufferGeometry, THREE.Material>, pageCount: number): LitMaterial {
  const material = mesh.material as THREE.MeshStandardMaterial;
  const index = parser.associations.get(material)?.materials;
  const definitions = (parser.json as { materials?: MaterialDef[] }).materials ?? [];
  const definition = index === undefined ? undefined : definitions[index];
  const page = definition?.extensions?.[lightmapExtension]?.page;
  if (typeof page !== 'number' || !Number.isInteger(page) || page < 0 || page >= pageCount) {
    throw new LoadError(url, text.error.noLightmap(material.name || `#${index ?? '?'}`));
  }
  const map = material.map;
  const hasVertexColors = mesh.geometry.getAttribute('color') !== undefined;
  // BLEND is cut at one half as well: a city's few blended textures (trees, railings) need no sorting then.
  const alphaCutoff = material.alphaTest > 0 ? material.alphaTest : material.transparent ? 0.5 : null;
  const look: SurfaceLook = {
    name: material.name,
    map,
    baseColor: material.color.clone(),
    baseAlpha: material.opacity,
    alphaCutoff,
    isDoubleSided: material.side === THREE.DoubleSide,
    hasVertexColors,
  };
  const key = [page, map?.uuid ?? '-', material.color.toArray().join(), material.opacity, alphaCutoff, look.isDoubleSided, hasVertexColors].join('|');
  return { page, look, key };
}

/** One indexed geometry of all meshes, with their world matrices applied: fewer draw calls (a city of 500 nodes drew a quarter faster). */
function mergeMeshes(meshes: readonly THREE.Mesh[], look: SurfaceLook): THREE.BufferGeometry {
  let vertexCount = 0;
  let indexCount = 0;
  for (const { geometry } of meshes) {
    const count = geometry.getAttribute('position').count;
    vertexCount += count;
    indexCount += geometry.index?.count ?? count;
  }
  const position = new Float32Array(vertexCount * 3);
  const uv = look.map ? new Float32Array(vertexCount * 2) : null;
  const uv1 = new Float32Array(vertexCount * 2);
  const chart = new Float32Array(vertexCount);
  const color = look.hasVertexColors ? new Float32Array(vertexCount * 3) : null;
  const index = new Uint32Array(indexCount);
  const corner = new THREE.Vector3();
  let vertex = 0;
  let slot = 0;
  for (const { geometry, matrixWorld } of meshes) {
    const source = geometry.getAttribute('position');
    for (let i = 0; i < source.count; ++i) corner.fromBufferAttribute(source, i).applyMatrix4(matrixWorld).toArray(position, 3 * (vertex + i));
    copyAttribute(geometry.getAttribute('uv1'), uv1, 2, vertex);
    copyAttribute(geometry.getAttribute('_chart'), chart, 1, vertex);
    if (uv) copyAttribute(geometry.getAttribute('uv'), uv, 2, vertex);
    if (color) copyAttribute(geometry.getAttribute('color'), color, 3, vertex);
    const count = geometry.index?.count ?? source.count;
    for (let i = 0; i < count; ++i) index[slot + i] = vertex + (geometry.index ? geometry.index.getX(i) : i);
    vertex += source.count;
    slot += count;
  }
  const merged = new THREE.BufferGeometry();
  merged.setAttribute('position', new THREE.BufferAttribute(position, 3));
  merged.setAttribute('uv1', new THREE.BufferAttribute(uv1, 2));
  merged.setAttribute('_chart', new THREE.BufferAttribute(chart, 1));
  if (uv) merged.setAttribute('uv', new THREE.BufferAttribute(uv, 2));
  if (color) merged.setAttribute('color', new THREE.BufferAttribute(color, 3));
  merged.setIndex(new THREE.BufferAttribute(index, 1));
  return merged;
}

function copyAttribute(source: THREE.BufferAttribute | THREE.InterleavedBufferAttribute | undefined, target: Float32Array, size: 1 | 2 | 3, firstVertex: number): void {
  if (!source) return;
  for (let i = 0; i < source.count; ++i) {
    for (let c = 0; c < size; ++c) target[(firstVertex + i) * size + c] = source.getComponent(i, c);
  }
}
