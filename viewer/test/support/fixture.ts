// A bake made by hand, in exactly the form that `skybake bake` writes: a square with three houses and a white card of known light.
// Sun and sky come from a few lines of their own, so that this scene judges the walkthrough and not the baker.
import fs from 'node:fs';
import path from 'node:path';
import type { Manifest } from '../../src/core/generated/manifest';
import { luminance, srgbEncode } from '../../src/core/units';
import { encodeExr } from './exr';
import { makeGlb } from './fixture_glb';
import { writeLayers } from './fixture_layers';
import { add, dot, length, type Chart, type Face, type V3 } from './fixture_shapes';
import { encodePng } from './png';

type Instant = Manifest['instants'][number];

interface Box { min: V3; max: V3; material: number }

const texelM = 0.5;
const gutter = 2;
const boxes: Box[] = [
  { min: [-32, 6, 0], max: [-14, 30, 14], material: 1 },
  { min: [4, 10, 0], max: [26, 24, 9], material: 1 },
  { min: [10, -30, 0], max: [22, -14, 24], material: 1 },
];

/** Those that stand in the bake that is being written. */
let standing = boxes;

/** Thick haze, so that a hundred metres are seen to matter. */
export function fixtureAir(instant: number): NonNullable<Instant['air']> {
  return {
    turbidity: 20,
    base_m: 0,
    molecules_per_m: [1e-4, 2e-4, 4e-4],
    haze_per_m: [1.5e-3, 1.6e-3, 1.7e-3],
    molecule_height_m: 8803,
    haze_height_m: 1200,
    airlight: { uri: `light/i${instant}_air.bin`, columns: 4, rows: 6, format: 'rgba16f', unit: 'kcd/m2' },
  };
}

/** The white card stands free and faces south; its light is written down, not computed. */
export const whiteCard = {
  center: [-20, -20, 2] as V3,
  skyKlx: [5, 8, 11] as V3,
  /** Of a lamp that lights nothing else. */
  lampKlx: [3, 2, 1] as V3,
  sunCosine: 0.5,
};

/** Label, sun azimuth and elevation in degrees, beam (klx), zenith and horizon colour of the sky (kcd/m²). */
const instants = [
  { label: '2026-06-21T10:00+02:00', utc: '2026-06-21T08:00:00Z', azimuth: 110, elevation: 48, beam: [88, 82, 72] as V3, zenith: [1.6, 2.6, 5.2] as V3, horizon: [6, 7, 8.2] as V3 },
  { label: '2026-06-21T19:00+02:00', utc: '2026-06-21T17:00:00Z', azimuth: 282, elevation: 14, beam: [48, 34, 18] as V3, zenith: [0.9, 1.4, 2.8] as V3, horizon: [5, 4.4, 3.8] as V3 },
];

export const fixtureInstants = instants.length;
/** Normal illuminance of the first instant's beam, klx. */
export const fixtureBeam = instants[0]!.beam;

/** Molecules evenly in the colour of the zenith; haze in that of the horizon, brighter towards the sun and unlike to its four sides. */
function airlight({ zenith, horizon }: (typeof instants)[number]): Buffer {
  const { columns, rows } = fixtureAir(0).airlight;
  const table = (value: (row: number, column: number) => V3) =>
    Array.from({ length: columns * rows }, (_, i) => [...value(Math.floor(i / columns), i % columns), 1]).flat();
  const numbers = [
    ...table(() => zenith),
    ...table((row, column) => horizon.map((l) => l * (0.6 + 0.8 * (1 - row / (rows - 1)) + (row > 0 ? 0.1 * column : 0))) as V3),
  ];
  const bytes = Buffer.alloc(2 * numbers.length);
  numbers.forEach((value, i) => bytes.writeUInt16LE(halfBits(value), 2 * i));
  return bytes;
}

function boxFaces(box: Box): Face[] {
  const [x0, y0, z0] = box.min;
  const [x1, y1, z1] = box.max;
  const [w, d, h] = [x1 - x0, y1 - y0, z1 - z0];
  // u runs along the wall's own horizontal, v downwards, as atlas.h has it.
  return [
    { corner: [x0, y0, z1], u: [w, 0, 0], v: [0, 0, -h], normal: [0, -1, 0], material: box.material },
    { corner: [x1, y1, z1], u: [-w, 0, 0], v: [0, 0, -h], normal: [0, 1, 0], material: box.material },
    { corner: [x1, y0, z1], u: [0, d, 0], v: [0, 0, -h], normal: [1, 0, 0], material: box.material },
    { corner: [x0, y1, z1], u: [0, -d, 0], v: [0, 0, -h], normal: [-1, 0, 0], material: box.material },
    { corner: [x0, y1, z1], u: [w, 0, 0], v: [0, -d, 0], normal: [0, 0, 1], material: 2 },
  ];
}

function faces(): { page: number; face: Face }[] {
  const ground: Face = { corner: [-60, 60, 0], u: [120, 0, 0], v: [0, -120, 0], normal: [0, 0, 1], material: 0 };
  const [cx, cy, cz] = whiteCard.center;
  const card: Face = { corner: [cx - 2, cy, cz + 2], u: [4, 0, 0], v: [0, 0, -4], normal: [0, -1, 0], material: 3, light: { sky: whiteCard.skyKlx, sunCosine: whiteCard.sunCosine } };
  return [{ page: 0, face: ground }, ...standing.flatMap(boxFaces).map((face) => ({ page: 1, face })), { page: 1, face: card }];
}

function hitsBox(from: V3, direction: V3, box: Box): boolean {
  let near = 1e-4;
  let far = Infinity;
  for (let axis = 0 as 0 | 1 | 2; axis < 3; ++axis) {
    const a = (box.min[axis] - from[axis]) / direction[axis];
    const b = (box.max[axis] - from[axis]) / direction[axis];
    near = Math.max(near, Math.min(a, b));
    far = Math.min(far, Math.max(a, b));
    if (near >= far) return false;
  }
  return true;
}

const isFree = (from: V3, direction: V3) => !standing.some((box) => hitsBox(from, direction, box));

function sunDirection(azimuthDeg: number, elevationDeg: number): V3 {
  const [a, e] = [(azimuthDeg * Math.PI) / 180, (elevationDeg * Math.PI) / 180];
  return [Math.sin(a) * Math.cos(e), Math.cos(a) * Math.cos(e), Math.sin(e)];
}

/** Direction to the first instant's sun. */
export const fixtureSun = sunDirection(instants[0]!.azimuth, instants[0]!.elevation);

/** 96 directions over the upper hemisphere: enough for soft corners. */
const dome: { direction: V3; solidAngle: number; rise: number }[] = [];
for (let ring = 0; ring < 6; ++ring) {
  for (let k = 0; k < 16; ++k) {
    const sine = (ring + 0.5) / 6;
    const cosine = Math.sqrt(1 - sine * sine);
    const azimuth = ((k + 0.5 * (ring % 2)) / 16) * 2 * Math.PI;
    dome.push({ direction: [cosine * Math.sin(azimuth), cosine * Math.cos(azimuth), sine], solidAngle: (2 * Math.PI) / 96, rise: sine });
  }
}

function skyRadiance(instant: (typeof instants)[number], sine: number): V3 {
  const t = Math.sqrt(sine);
  return [0, 1, 2].map((c) => instant.horizon[c as 0]! * (1 - t) + instant.zenith[c as 0]! * t) as V3;
}

/** Light of all instants at a point: what a direction sees is asked once. */
function lightsAt(face: Face, point: V3): { sky: V3; sunCosine: number }[] {
  if (face.light) return instants.map(() => face.light!);
  const from = add(point, face.normal, 0.01);
  const skies = instants.map((): V3 => [0, 0, 0]);
  for (const [k, { direction, solidAngle }] of dome.entries()) {
    const cosine = dot(face.normal, direction);
    if (cosine <= 0 || !isFree(from, direction)) continue;
    skies.forEach((sky, i) => {
      for (let c = 0 as 0 | 1 | 2; c < 3; ++c) sky[c] += domeRadiance[i]![k]![c] * cosine * solidAngle;
    });
  }
  return instants.map((instant, i) => {
    const sun = sunDirection(instant.azimuth, instant.elevation);
    const cosine = Math.max(0, dot(face.normal, sun));
    return { sky: skies[i]!, sunCosine: cosine > 0 && isFree(from, sun) ? cosine : 0 };
  });
}

const domeRadiance = instants.map((instant) => dome.map(({ rise }) => skyRadiance(instant, rise)));

/** Rows of charts beside each other; page 0 has the ground alone. */
function pack(): { charts: Chart[]; pages: { width: number; height: number }[] } {
  const pages = [{ width: 256, height: 256 }, { width: 256, height: 256 }];
  const pen = pages.map(() => ({ x: gutter, y: gutter, rowHeight: 0 }));
  const charts = faces().map(({ face, page }) => {
    const columns = Math.ceil(length(face.u) / texelM);
    const rows = Math.ceil(length(face.v) / texelM);
    const at = pen[page]!;
    if (at.x + columns + gutter > pages[page]!.width) {
      at.x = gutter;
      at.y += at.rowHeight + 2 * gutter;
      at.rowHeight = 0;
    }
    const chart: Chart = { face, page, x: at.x, y: at.y, columns, rows };
    at.x += columns + 2 * gutter;
    at.rowHeight = Math.max(at.rowHeight, rows);
    if (at.y + rows + gutter > pages[page]!.height) throw new Error('the fixture has outgrown its pages');
    return chart;
  });
  return { charts, pages };
}

function halfBits(value: number): number {
  if (value <= 0) return 0;
  const exponent = Math.max(-14, Math.floor(Math.log2(value)));
  return Math.round(((exponent + 15) << 10) + (value / 2 ** exponent - 1) * 1024);
}

function panorama(instant: (typeof instants)[number], width: number, height: number): Buffer {
  const out = Buffer.alloc(width * height * 8);
  const sun = sunDirection(instant.azimuth, instant.elevation);
  for (let row = 0; row < height; ++row) {
    const elevation = 90 - (row / (height - 1)) * 90;
    for (let column = 0; column < width; ++column) {
      const direction = sunDirection(((column + 0.5) / width) * 360, elevation);
      const aureole = 4 * Math.exp(-Math.acos(Math.min(1, dot(direction, sun))) / 0.25);
      const base = skyRadiance(instant, direction[2]);
      [...base.map((c) => c + aureole), 1].forEach((c, k) => out.writeUInt16LE(halfBits(c), 8 * (row * width + column) + 2 * k));
    }
  }
  return out;
}

/** Written down, not computed: of the ground, of roofs, of walls. */
function skyViewOf(chart: Chart | undefined): number {
  if (!chart) return 1;
  return chart.page === 0 ? 0.8 : chart.face.normal[2] > 0.5 ? 1 : 0.4;
}

/** Writes the bake into an empty folder; before the third house was built, when asked for. */
export function writeFixture(folder: string, time: 'before' | 'after' = 'after'): Manifest {
  standing = time === 'before' ? boxes.slice(0, 2) : boxes;
  const { charts, pages } = pack();
  for (const name of ['light', 'layers']) fs.mkdirSync(path.join(folder, name), { recursive: true });
  const written = new Map<string, number>();
  const write = (name: string, bytes: Uint8Array) => {
    fs.writeFileSync(path.join(folder, name), bytes);
    written.set(name, bytes.byteLength);
  };
  write('city.glb', makeGlb(charts, pages));

  const lights = charts.map((chart) => {
    const texels: { sky: V3; sunCosine: number }[][] = [];
    for (let row = 0; row < chart.rows; ++row) {
      for (let column = 0; column < chart.columns; ++column) {
        const along = add(chart.face.corner, chart.face.u, (column + 0.5) / chart.columns);
        texels.push(lightsAt(chart.face, add(along, chart.face.v, (row + 0.5) / chart.rows)));
      }
    }
    return texels;
  });

  const lampScale = Math.max(...whiteCard.lampKlx);
  const lampPages = pages.map(({ width, height }) => new Uint8Array(width * height * 3));
  for (const chart of charts.filter(({ face }) => face.light)) {
    for (let row = -gutter; row < chart.rows + gutter; ++row) {
      for (let column = -gutter; column < chart.columns + gutter; ++column) {
        const at = (chart.y + row) * pages[chart.page]!.width + chart.x + column;
        lampPages[chart.page]!.set(whiteCard.lampKlx.map((e) => Math.round(255 * srgbEncode(e / lampScale))), 3 * at);
      }
    }
  }
  /** The chart and the texel of it at a place of a page; null outside of every chart. */
  const texelAt = (p: number, column: number, row: number): { c: number; index: number } | null => {
    const c = charts.findIndex((chart) => chart.page === p && column >= chart.x && column < chart.x + chart.columns && row >= chart.y && row < chart.y + chart.rows);
    const chart = charts[c];
    return chart ? { c, index: (row - chart.y) * chart.columns + column - chart.x } : null;
  };
  const rgb = (prefix: string, value: (p: number, column: number, row: number) => V3, p: number) =>
    ['R', 'G', 'B'].map((name, channel) => ({ name: prefix + name, value: (column: number, row: number) => 1000 * value(p, column, row)[channel as 0 | 1 | 2] }));
  const lampAt = (p: number, column: number, row: number): V3 => (charts[texelAt(p, column, row)?.c ?? -1]?.face.light ? whiteCard.lampKlx : [0, 0, 0]);
  pages.forEach(({ width, height }, p) => write(`light/p${p}_base.exr`, encodeExr(width, height, [
    { name: 'state', isInteger: true, value: (column, row) => (texelAt(p, column, row) ? 1 : 0) },
    { name: 'chart', isInteger: true, value: (column, row) => texelAt(p, column, row)?.c ?? 0 },
    { name: 'sky_view_factor', value: (column, row) => skyViewOf(charts[texelAt(p, column, row)?.c ?? -1]) },
    ...rgb('lamps.', lampAt, p),
  ])));
  pages.forEach(({ width, height }, p) => write(`light/p${p}_svf.png`, encodePng({ width, height, channels: 1, pixels: Uint8Array.from({ length: width * height }, (_, i) =>
    Math.round(255 * skyViewOf(charts[texelAt(p, i % width, Math.floor(i / width))?.c ?? -1]))) })));
  write('objects.json', Buffer.from(JSON.stringify({
    format: 'skybake-objects',
    version: 1,
    objects: [{ id: 'square', type: 'terrain' }, ...[1, 2, 3].map((n) => ({ id: `house-${n}`, type: 'building', attributes: { storeys: n + 2, name: `House “${n}”` } })), { id: 'card', type: 'generic' }],
    surface_types: ['terrain', 'wall', 'roof'],
    chart_objects: charts.map((_, c) => (c === 0 ? 0 : c === charts.length - 1 ? 4 : 1 + Math.floor((c - 1) / 5))),
    chart_surfaces: charts.map(({ face }, c) => (c === 0 ? 0 : face.normal[2] > 0.5 ? 2 : 1)),
  })));

  const layers = writeLayers(pages, (p, column, row) => charts[texelAt(p, column, row)?.c ?? -1] ?? null, charts, gutter, write);
  pages.forEach((page, p) => write(`light/p${p}_lamps.png`, encodePng({ ...page, channels: 3, pixels: lampPages[p]! })));
  write('light/lamp_scales.bin', Buffer.from(new Float32Array(charts.map(({ face }) => (face.light ? lampScale : 0))).buffer));

  const manifestInstants = instants.map((instant, i): Instant => {
    const scales = new Float32Array(charts.length * 2);
    const sky = pages.map(({ width, height }) => new Uint8Array(width * height * 3));
    const sun = pages.map(({ width, height }) => new Uint8Array(width * height));
    let luminanceSum = 0;
    let texels = 0;
    charts.forEach((chart, c) => {
      const own = lights[c]!.map((texel) => texel[i]!);
      const skyScale = own.reduce((most, texel) => Math.max(most, ...texel.sky), 1e-3);
      const sunScale = own.reduce((most, texel) => Math.max(most, texel.sunCosine), 1e-3);
      scales.set([skyScale, sunScale], 2 * c);
      for (let row = -gutter; row < chart.rows + gutter; ++row) {
        for (let column = -gutter; column < chart.columns + gutter; ++column) {
          // The gutter repeats the nearest texel of the chart.
          const nearestRow = Math.min(chart.rows - 1, Math.max(0, row));
          const texel = own[nearestRow * chart.columns + Math.min(chart.columns - 1, Math.max(0, column))]!;
          const at = (chart.y + row) * pages[chart.page]!.width + chart.x + column;
          sky[chart.page]!.set(texel.sky.map((e) => Math.round(255 * srgbEncode(e / skyScale))), 3 * at);
          sun[chart.page]![at] = Math.round((255 * texel.sunCosine) / sunScale);
        }
      }
      for (const texel of own) {
        const lamp: V3 = chart.face.light ? whiteCard.lampKlx : [0, 0, 0];
        luminanceSum += luminance(add(add(texel.sky, lamp), instant.beam, texel.sunCosine)) / Math.PI;
        ++texels;
      }
    });
    write(`light/i${i}_scales.bin`, Buffer.from(scales.buffer));
    write(`light/i${i}_sky.bin`, panorama(instant, 512, 128));
    write(`light/i${i}_air.bin`, airlight(instant));
    const lightAt = (p: number, column: number, row: number) => {
      const at = texelAt(p, column, row);
      return at ? lights[at.c]![at.index]![i]! : null;
    };
    const sunAt = (p: number, column: number, row: number): V3 => instant.beam.map((e) => e * (lightAt(p, column, row)?.sunCosine ?? 0)) as V3;
    const skyAt = (p: number, column: number, row: number): V3 => lightAt(p, column, row)?.sky ?? [0, 0, 0];
    pages.forEach(({ width, height }, p) => write(`light/i${i}_p${p}.exr`, encodeExr(width, height, [
      ...rgb('', (...at) => add(add(sunAt(...at), skyAt(...at)), lampAt(...at)), p), ...rgb('sun.', sunAt, p), ...rgb('sky.', skyAt, p),
    ])));
    pages.forEach((page, p) => {
      write(`light/i${i}_p${p}_sky.png`, encodePng({ ...page, channels: 3, pixels: sky[p]! }));
      write(`light/i${i}_p${p}_sun.png`, encodePng({ ...page, channels: 1, pixels: sun[p]! }));
    });
    return {
      label: instant.label,
      utc: instant.utc,
      sun: {
        shape: 'point',
        azimuth_deg: instant.azimuth,
        elevation_deg: instant.elevation,
        direction: sunDirection(instant.azimuth, instant.elevation),
        normal_illuminance_klx: instant.beam,
        dni_w_m2: 800,
        angular_radius_deg: 0.2665,
      },
      sky: { model: 'made by hand', panorama: { uri: `light/i${i}_sky.bin`, width: 512, height: 128, format: 'rgba16f', unit: 'kcd/m2' }, land_kcd_m2: [4, 3.9, 3.5] },
      air: fixtureAir(i),
      scales: { uri: `light/i${i}_scales.bin` },
      exposure_hint: (0.5 * texels) / luminanceSum,
      pages: pages.map((_, p) => ({ exr: `light/i${i}_p${p}.exr`, sky: `light/i${i}_p${p}_sky.png`, sun: `light/i${i}_p${p}_sun.png` })),
    };
  });

  const manifest: Manifest = {
    format: 'skybake-bake',
    version: 1,
    generator: { name: 'skybake viewer fixture', version: '1' },
    title: time === 'before' ? 'Two houses' : 'Three houses',
    crs: '',
    site: { latitude_deg: 47, longitude_deg: 15.4 },
    convergence_deg: 0,
    origin: [0, 0, 0],
    bounds: { min: [-60, -60, 0], max: [60, 60, 24] },
    texel_m: texelM,
    seed: 0,
    sky_samples: dome.length,
    sampling: 'full',
    tolerance: 0,
    settings: {},
    inputs: [],
    isa: 'none',
    units: { illuminance: 'lx', luminance: 'cd/m2', length: 'm', angle: 'degree', color: 'linear Rec. 709, photometric: 0.2126 R + 0.7152 G + 0.0722 B is the illuminance or luminance' },
    pages: pages.map(({ width, height }, p) => ({ width, height, base: `light/p${p}_base.exr`, svf: `light/p${p}_svf.png`, lamps: `light/p${p}_lamps.png` })),
    charts: charts.length,
    objects: { uri: 'objects.json' },
    lamp_scales: { uri: 'light/lamp_scales.bin' },
    instants: manifestInstants,
    layers,
    views: [
      { name: 'From the south-east', position: [70, -85, 55], target: [0, 0, 4] },
      { name: 'On the square', position: [-8, -34, 1.7], target: [4, 10, 5] },
    ],
    files: [...written].map(([name, bytes]) => ({ name, bytes })).sort((a, b) => (a.name < b.name ? -1 : 1)),
    report: { buildings: 3, triangles: charts.length * 2, charts: charts.length, pages: pages.length, texels: charts.reduce((sum, c) => sum + c.columns * c.rows, 0), texel_m: texelM, rays: { sun: 0, sky: 0, photon: 0, feeler: 0 }, evaluated_fraction: 1, predicted_rmse_over_mean: 0 },
    findings: [],
  };
  fs.writeFileSync(path.join(folder, 'manifest.json'), JSON.stringify(manifest, null, 1));
  return manifest;
}
