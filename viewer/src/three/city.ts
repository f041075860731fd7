import * as THREE from 'three';
import { GLTFLoader, type GLTF, type GLTFLoaderPlugin, type GLTFParser } from 'three/addons/loaders/GLTFLoader.js';
import { LoadError } from '../core/load_error';
import { text } from '../core/text';
import { makeBatches, type Batch, type CityPart } from './city_batches';
import { makeCityMaterial, type SharedUniforms } from './city_material';
import type { LayerPainter } from './layers';

const lightmapExtension = 'SKYBAKE_lightmap';

/** The city as few batches, in scene coordinates. */
export interface City {
  group: THREE.Group;
  /** What is drawn with one call each, as children of the group. */
  batches: Batch[];
  triangleCount: number;
  /** Primitives of the file, before they were joined. */
  primitiveCount: number;
  /** Albedo textures on the graphics card, with their mip levels. */
  textureBytes: number;
  chartCount: number;
  bounds: THREE.Box3;
  dispose(): void;
}

/** What is read of its primitives. */
export const cityAttributes = ['POSITION', 'TEXCOORD_0', 'TEXCOORD_1', '_CHART'] as const;

interface MeshDef {
  primitives: { attributes: Record<string, number> }[];
}

interface MaterialDef {
  occlusionTexture?: unknown;
  normalTexture?: unknown;
  emissiveTexture?: unknown;
  extensions?: Record<string, { page?: unknown } | undefined>;
  pbrMetallicRoughness?: { metallicRoughnessTexture?: unknown };
}

/** Drops what the baked light replaces before GLTFLoader reads it: normals and the occlusion texture serve viewers that know no lightmap. They may not even be there. */
class ForgetReplacedTextures implements GLTFLoaderPlugin {
  readonly name = lightmapExtension;
  constructor(private readonly parser: GLTFParser) {}

  async beforeRoot(): Promise<void> {
    const materials = ((this.parser.json as { materials?: MaterialDef[] }).materials ?? []);
    for (const { primitives } of (this.parser.json as { meshes?: MeshDef[] }).meshes ?? []) {
      for (const { attributes } of primitives) delete attributes['NORMAL'];
    }
    for (const material of materials) {
      delete material.occlusionTexture;
      delete material.normalTexture;
      delete material.emissiveTexture;
      delete material.pbrMetallicRoughness?.metallicRoughnessTexture;
    }
  }
}

/** Parses city.glb, of which `bytesNeededOfGlb` bytes are enough. `pageSizes` are the manifest's. Throws LoadError when it is no glTF, or when a part of it cannot be lit. */
export async function loadCity(url: string, bytes: Uint8Array<ArrayBuffer>, pageSizes: readonly { width: number; height: number }[], shared: SharedUniforms, painter: LayerPainter, maxAnisotropy: number): Promise<City> {
  const loader = new GLTFLoader();
  loader.register((parser) => new ForgetReplacedTextures(parser));
  let gltf: GLTF;
  try {
    gltf = await loader.parseAsync(bytes.buffer, THREE.LoaderUtils.extractUrlBase(url));
  } catch (error) {
    throw new LoadError(url, text.error.notAModel(error instanceof Error ? error.message : String(error)));
  }
  gltf.scene.updateMatrixWorld(true);

  const parts: CityPart[] = [];
  gltf.scene.traverse((object) => {
    if (object instanceof THREE.Mesh) parts.push(readPart(url, gltf.parser, object as THREE.Mesh<THREE.BufferGeometry, THREE.Material>, pageSizes));
  });
  if (parts.length === 0) throw new LoadError(url, text.error.emptyModel);

  const batches = await makeBatches(parts, painter, Math.min(8, maxAnisotropy));
  const group = new THREE.Group();
  group.matrixAutoUpdate = false;
  const bounds = new THREE.Box3();
  let triangleCount = 0;
  let chartCount = 0;
  for (const { geometry, layers, isCutOut, isDoubleSided } of batches) {
    const mesh = new THREE.Mesh(geometry, makeCityMaterial(layers?.texture ?? null, isCutOut, isDoubleSided, shared));
    mesh.matrixAutoUpdate = false;
    group.add(mesh);
    if (geometry.boundingBox) bounds.union(geometry.boundingBox);
    triangleCount += (geometry.index?.count ?? 0) / 3;
    const charts = geometry.getAttribute('chart').array;
    for (let i = 0; i < charts.length; ++i) chartCount = Math.max(chartCount, (charts[i] ?? 0) + 1);
  }
  const layers = new Set(batches.flatMap((batch) => batch.layers ?? []));
  const texels = [...layers].reduce((sum, { width, height, depth }) => sum + width * height * depth, 0);
  return {
    group,
    batches,
    triangleCount,
    primitiveCount: parts.length,
    textureBytes: Math.round(((4 * 4) / 3) * texels),
    chartCount,
    bounds,
    dispose() {
      for (const child of group.children) {
        const mesh = child as THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial>;
        mesh.geometry.dispose();
        mesh.material.dispose();
      }
      for (const target of layers) target.dispose();
    },
  };
}

function readPart(url: string, parser: GLTFParser, mesh: THREE.Mesh<THREE.BufferGeometry, THREE.Material>, pageSizes: readonly { width: number; height: number }[]): CityPart {
  const material = mesh.material as THREE.MeshStandardMaterial;
  const index = parser.associations.get(material)?.materials;
  const definitions = (parser.json as { materials?: MaterialDef[] }).materials ?? [];
  const definition = index === undefined ? undefined : definitions[index];
  const page = definition?.extensions?.[lightmapExtension]?.page;
  const pageSize = typeof page === 'number' ? pageSizes[page] : undefined;
  if (typeof page !== 'number' || !pageSize) throw new LoadError(url, text.error.noLightmap(material.name || `#${index ?? '?'}`));
  if (!mesh.geometry.getAttribute('uv1') || !mesh.geometry.getAttribute('_chart')) throw new LoadError(url, text.error.noCoordinates(mesh.name));
  const { map, color } = material;
  // BLEND is cut at one half as well: a city's few blended textures (trees, railings) need no sorting then.
  const cutoff = material.alphaTest > 0 ? material.alphaTest : material.transparent ? 0.5 : null;
  return {
    geometry: mesh.geometry,
    matrixWorld: mesh.matrixWorld,
    page,
    pageSize,
    map,
    tint: new THREE.Vector4(color.r, color.g, color.b, cutoff === null ? 1 : (0.5 * material.opacity) / cutoff),
    isCutOut: map !== null && cutoff !== null,
    isDoubleSided: material.side === THREE.DoubleSide,
  };
}
