// Layers of a study in the synthetic bake: numbers that are written down, one layer of each kind.
import type { Manifest } from '../../src/core/generated/manifest';
import { encodeExr } from './exr';
import type { Chart } from './fixture_shapes';
import { encodePng } from './png';

type Layer = NonNullable<Manifest['layers']>[number];

interface Made { layer: Omit<Layer, 'pages'>; value: (chart: Chart, column: number) => number }

const isRoof = ({ face }: Chart) => face.normal[2] > 0.5;
const isGround = ({ page }: Chart) => page === 0;
const isCard = ({ face }: Chart) => face.light !== undefined;

const made: Made[] = [
  {
    layer: { id: 'sun_hours_2026-03-21', title: { en: 'Sun hours, 21 March 2026', de: 'Sonnenstunden, 21. März 2026' }, unit: 'h', minimum: 0, maximum: 12, edges: [0, 1, 2, 4, 6, 8], kind: 'sequential' },
    value: (chart, column) => (isGround(chart) ? (12 * (column + 0.5)) / chart.columns : isCard(chart) ? 5.25 : isRoof(chart) ? 10.5 : 1.5),
  },
  {
    layer: { id: 'irradiation', title: { en: 'Solar energy in a year', de: 'Sonnenenergie im Jahr' }, unit: 'kWh/m2', minimum: 0, maximum: 1200, kind: 'sequential' },
    value: (chart, column) => (isGround(chart) ? 600 + (300 * (column + 0.5)) / chart.columns : isCard(chart) ? 612.5 : isRoof(chart) ? 1100 : 420),
  },
  {
    layer: { id: 'sun_hours_change', title: { en: 'Change of sun hours', de: 'Änderung der Sonnenstunden' }, unit: 'h', minimum: -3, maximum: 2, edges: [-3, -2, -1, -0.5, 0.5, 1, 2], kind: 'diverging' },
    value: (chart, column) => (isGround(chart) ? -3 + (5 * (column + 0.5)) / chart.columns : isCard(chart) ? -1.5 : isRoof(chart) ? 1.25 : 0),
  },
];

/** Of the white card. */
export const cardLayers = { 'sun_hours_2026-03-21': 5.25, irradiation: 612.5, sun_hours_change: -1.5 } as const;

/** @param chartAt null outside of every chart */
export function writeLayers(
  pages: readonly { width: number; height: number }[],
  chartAt: (page: number, column: number, row: number) => Chart | null,
  charts: readonly Chart[],
  gutter: number,
  write: (name: string, bytes: Uint8Array) => void,
): Layer[] {
  return made.map(({ layer, value }) => {
    const { minimum, maximum } = layer;
    pages.forEach(({ width, height }, p) => {
      const pixels = new Uint8Array(width * height);
      for (const chart of charts.filter(({ page }) => page === p)) {
        for (let row = -gutter; row < chart.rows + gutter; ++row) {
          for (let column = -gutter; column < chart.columns + gutter; ++column) {
            const nearest = Math.min(chart.columns - 1, Math.max(0, column));
            pixels[(chart.y + row) * width + chart.x + column] = Math.round((255 * (value(chart, nearest) - minimum)) / (maximum - minimum));
          }
        }
      }
      write(`layers/${layer.id}_${p}.png`, encodePng({ width, height, channels: 1, pixels }));
      write(`layers/${layer.id}_${p}.exr`, encodeExr(width, height, [{
        name: 'value',
        value: (column, row) => {
          const chart = chartAt(p, column, row);
          return chart ? value(chart, column - chart.x) : NaN;
        },
      }]));
    });
    return { ...layer, pages: pages.map((_, p) => ({ png: `layers/${layer.id}_${p}.png`, exr: `layers/${layer.id}_${p}.exr` })) };
  });
}
