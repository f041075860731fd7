// What a place sees of the sky, with the sun's ways: a stereographic disc, north up and east to the right as on a map.
import { cellDeg, columns, rows, type Dome, type SunPoint } from '../core/obstruction';
import { text } from '../core/text';

export interface SunChartContent {
  dome: Dome;
  /** Azimuth of grid north, clockwise from true north: the disc has true north on top. */
  convergenceDeg: number;
  paths: { points: readonly SunPoint[]; label: string; isToday: boolean }[];
  /** Full hours of today's path. */
  hours: { point: SunPoint; label: string }[];
  sun: { azimuthDeg: number; elevationDeg: number } | null;
  description: string;
}

const size = 320;
const radius = 132;
const svgSpace = 'http://www.w3.org/2000/svg';

function node(tag: string, attributes: Readonly<Record<string, string>>, words = ''): SVGElement {
  const made = document.createElementNS(svgSpace, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.textContent = words;
  return made;
}

export function sunChart({ dome, convergenceDeg, paths, hours, sun, description }: SunChartContent): SVGElement {
  /** Stereographic: the radius is tan(zenith angle / 2). */
  const place = (azimuthDeg: number, elevationDeg: number): [number, number] => {
    const azimuth = ((azimuthDeg + convergenceDeg) * Math.PI) / 180;
    const r = radius * Math.tan(((90 - elevationDeg) * Math.PI) / 360);
    return [size / 2 + r * Math.sin(azimuth), size / 2 - r * Math.cos(azimuth)];
  };
  const point = (azimuthDeg: number, elevationDeg: number): string => place(azimuthDeg, elevationDeg).map((v) => v.toFixed(1)).join(' ');

  /** The cells of a state, runs of a column joined. */
  const area = (state: number): string => {
    let path = '';
    for (let column = 0; column < columns; ++column) {
      for (let row = 0; row < rows; ++row) {
        if (dome[row * columns + column] !== state) continue;
        const low = row;
        while (row + 1 < rows && dome[(row + 1) * columns + column] === state) ++row;
        const [left, right, bottom, top] = [column * cellDeg - 0.05, (column + 1) * cellDeg + 0.05, low * cellDeg, (row + 1) * cellDeg];
        path += `M${point(left, bottom)}L${point(right, bottom)}L${point(right, top)}L${point(left, top)}Z`;
      }
    }
    return path;
  };

  const chart = node('svg', { viewBox: `0 0 ${size} ${size}`, class: 'sun-chart', role: 'img', 'aria-label': description });
  chart.append(node('circle', { cx: `${size / 2}`, cy: `${size / 2}`, r: `${radius}`, class: 'dome' }));
  chart.append(node('path', { d: area(2), class: 'behind' }), node('path', { d: area(1), class: 'obstruction' }));
  for (const elevation of [30, 60]) {
    chart.append(node('circle', { cx: `${size / 2}`, cy: `${size / 2}`, r: (radius * Math.tan(((90 - elevation) * Math.PI) / 360)).toFixed(1), class: 'ring' }));
    const [x, y] = [size / 2, size / 2 - radius * Math.tan(((90 - elevation) * Math.PI) / 360)];
    chart.append(node('text', { x: `${x + 3}`, y: `${y - 3}`, class: 'small' }, `${elevation}°`));
  }
  for (const [azimuth, name] of [[0, text.measure.north], [90, text.measure.east], [180, text.measure.south], [270, text.measure.west]] as const) {
    const angle = (azimuth * Math.PI) / 180;
    chart.append(node('text', { x: `${size / 2 + (radius + 13) * Math.sin(angle)}`, y: `${size / 2 - (radius + 13) * Math.cos(angle) + 5}`, class: 'compass' }, name));
  }
  for (const { points, label, isToday } of paths) {
    if (points.length < 2) continue;
    chart.append(node('polyline', { points: points.map((p) => place(p.azimuthDeg, p.elevationDeg).map((v) => v.toFixed(1)).join(',')).join(' '), class: isToday ? 'path today' : 'path' }));
    const noon = points.reduce((best, p) => (p.elevationDeg > best.elevationDeg ? p : best));
    const [x, y] = place(noon.azimuthDeg, noon.elevationDeg);
    if (!isToday) chart.append(node('text', { x: x.toFixed(1), y: (y - 4).toFixed(1), class: 'small middle' }, label));
  }
  for (const { point: p, label } of hours) {
    const [x, y] = place(p.azimuthDeg, p.elevationDeg);
    chart.append(node('circle', { cx: x.toFixed(1), cy: y.toFixed(1), r: '2.2', class: 'hour' }), node('text', { x: x.toFixed(1), y: (y + 13).toFixed(1), class: 'small middle' }, label));
  }
  if (sun && sun.elevationDeg > 0) {
    const [x, y] = place(sun.azimuthDeg, sun.elevationDeg);
    chart.append(node('circle', { cx: x.toFixed(1), cy: y.toFixed(1), r: '6', class: 'sun' }));
  }
  return chart;
}
