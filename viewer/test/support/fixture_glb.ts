// The model of the synthetic bake, in the form of src/io/gltf.
import { add, length, type Chart } from './fixture_shapes';
import { encodePng } from './png';

const materials = [
  { name: 'paving', color: [0.32, 0.3, 0.27], texture: 'paving' },
  { name: 'plaster', color: [0.62, 0.5, 0.36], texture: 'windows' },
  { name: 'tiles', color: [0.42, 0.16, 0.1], texture: null },
  { name: 'white card', color: [1, 1, 1], texture: null },
] as const;

function paint(name: string): { width: number; height: number; channels: 3; pixels: Uint8Array } {
  const size = 64;
  const pixels = new Uint8Array(size * size * 3);
  for (let y = 0; y < size; ++y) {
    for (let x = 0; x < size; ++x) {
      const isWindow = name === 'windows' && x >= 20 && x < 44 && y >= 14 && y < 46;
      const isJoint = name === 'paving' && (x % 32 === 0 || y % 32 === 0);
      const shade = isWindow ? 70 : isJoint ? 170 : 235 + ((x * 7 + y * 13) % 11);
      pixels.set([shade, shade, isWindow ? 90 : shade], 3 * (y * size + x));
    }
  }
  return { width: size, height: size, channels: 3, pixels };
}

/** glTF 2.0 binary: one primitive for each material and page, y up. */
export function makeGlb(charts: readonly Chart[], pages: readonly { width: number; height: number }[]): Buffer {
  const views: object[] = [];
  const accessors: object[] = [];
  const bytes: Buffer[] = [];
  let size = 0;
  const addView = (data: Buffer): number => {
    views.push({ buffer: 0, byteOffset: size, byteLength: data.length });
    const padded = Buffer.concat([data, Buffer.alloc((4 - (data.length % 4)) % 4)]);
    bytes.push(padded);
    size += padded.length;
    return views.length - 1;
  };
  const addAccessor = (values: number[], type: 'SCALAR' | 'VEC2' | 'VEC3', extra: object = {}): number => {
    const components = { SCALAR: 1, VEC2: 2, VEC3: 3 }[type];
    accessors.push({ bufferView: addView(Buffer.from(new Float32Array(values).buffer)), componentType: 5126, count: values.length / components, type, ...extra });
    return accessors.length - 1;
  };
  const images = ['paving', 'windows'].map((name) => ({ bufferView: addView(encodePng(paint(name))), mimeType: 'image/png' }));

  const gltfMaterials: object[] = [];
  const primitives: { attributes: Record<string, number>; indices: number; material: number }[] = [];
  const normals: number[][] = [];
  for (const [m, material] of materials.entries()) {
    for (const page of pages.keys()) {
      const own = charts.map((chart, index) => ({ chart, index })).filter(({ chart }) => chart.face.material === m && chart.page === page);
      if (own.length === 0) continue;
      const position: number[] = [];
      const uv: number[] = [];
      const uv1: number[] = [];
      const chartOf: number[] = [];
      const normal: number[] = [];
      const index: number[] = [];
      for (const { chart, index: c } of own) {
        const first = chartOf.length;
        for (const [s, t] of [[0, 0], [1, 0], [1, 1], [0, 1]] as const) {
          const [x, y, z] = add(add(chart.face.corner, chart.face.u, s), chart.face.v, t);
          position.push(x, z, -y);
          normal.push(chart.face.normal[0], chart.face.normal[2], -chart.face.normal[1]);
          uv.push((s * length(chart.face.u)) / 3, (t * length(chart.face.v)) / 3);
          uv1.push((chart.x + s * chart.columns) / pages[page]!.width, (chart.y + t * chart.rows) / pages[page]!.height);
          chartOf.push(c);
        }
        index.push(first, first + 2, first + 1, first, first + 3, first + 2);
      }
      const corners = [0, 1, 2].map((axis) => position.filter((_, i) => i % 3 === axis));
      const indices = { bufferView: addView(Buffer.from(new Uint32Array(index).buffer)), componentType: 5125, count: index.length, type: 'SCALAR' };
      accessors.push(indices);
      const indexAccessor = accessors.length - 1;
      gltfMaterials.push({
        name: material.name,
        doubleSided: true,
        pbrMetallicRoughness: {
          baseColorFactor: [...material.color, 1],
          metallicFactor: 0,
          ...(material.texture ? { baseColorTexture: { index: material.texture === 'paving' ? 0 : 1 } } : {}),
        },
        occlusionTexture: { index: images.length, texCoord: 1 },
        extensions: { SKYBAKE_lightmap: { page, texCoord: 1 } },
      });
      normals.push(normal);
      primitives.push({
        attributes: {
          POSITION: addAccessor(position, 'VEC3', { min: corners.map((c) => Math.min(...c)), max: corners.map((c) => Math.max(...c)) }),
          TEXCOORD_0: addAccessor(uv, 'VEC2'),
          TEXCOORD_1: addAccessor(uv1, 'VEC2'),
          _CHART: addAccessor(chartOf, 'SCALAR'),
        },
        indices: indexAccessor,
        material: gltfMaterials.length - 1,
      });
    }
  }
  // What the walkthrough does without stands last, as the writer has it; the picture is larger than what comes in one piece.
  primitives.forEach(({ attributes }, p) => (attributes['NORMAL'] = addAccessor(normals[p]!, 'VEC3')));
  const occlusion = { width: 512, height: 256, channels: 3, pixels: Uint8Array.from({ length: 512 * 256 * 3 }, (_, i) => Math.abs(1e7 * Math.sin(i * i))) } as const;
  images.push({ bufferView: addView(encodePng(occlusion)), mimeType: 'image/png' });
  const json = Buffer.from(JSON.stringify({
    asset: { version: '2.0' },
    extensionsUsed: ['SKYBAKE_lightmap'],
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives }],
    materials: gltfMaterials,
    textures: images.map((_, source) => ({ source, sampler: 0 })),
    samplers: [{ magFilter: 9729, minFilter: 9987, wrapS: 10497, wrapT: 10497 }],
    images,
    accessors,
    bufferViews: views,
    buffers: [{ byteLength: size }],
  }));
  const jsonChunk = Buffer.concat([json, Buffer.alloc((4 - (json.length % 4)) % 4, 0x20)]);
  const header = Buffer.alloc(20);
  header.write('glTF', 0, 'latin1');
  header.writeUInt32LE(2, 4);
  header.writeUInt32LE(28 + jsonChunk.length + size, 8);
  header.writeUInt32LE(jsonChunk.length, 12);
  header.write('JSON', 16, 'latin1');
  const binHeader = Buffer.alloc(8);
  binHeader.writeUInt32LE(size, 0);
  binHeader.write('BIN\0', 4, 'latin1');
  return Buffer.concat([header, jsonChunk, binHeader, ...bytes]);
}
