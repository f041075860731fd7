import { LoadError } from './load_error';
import { text } from './text';
import { halfToNumber, type Vec3 } from './units';

/**
 * The sky as rows of RGBA half floats, kcd/m²: row 0 at the zenith, the last at the horizon, columns clockwise from grid north.
 * The texture takes the halves as they are; what the CPU wants to know is computed from them here.
 */
export class Panorama {
  constructor(
    readonly width: number,
    readonly height: number,
    readonly halves: Uint16Array<ArrayBuffer>,
  ) {}

  static fromBytes(url: string, bytes: Uint8Array<ArrayBuffer>, width: number, height: number): Panorama {
    const needed = width * height * 4 * 2;
    if (bytes.byteLength !== needed) throw new LoadError(url, text.error.size(bytes.byteLength, needed));
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const halves = new Uint16Array(width * height * 4);
    for (let i = 0; i < halves.length; ++i) halves[i] = view.getUint16(2 * i, true);
    return new Panorama(width, height, halves);
  }

  /** kcd/m² at the centre of a column and row. */
  at(column: number, row: number): [number, number, number] {
    const i = 4 * (row * this.width + column);
    return [halfToNumber(this.halves[i] ?? 0), halfToNumber(this.halves[i + 1] ?? 0), halfToNumber(this.halves[i + 2] ?? 0)];
  }

  /** Illuminance of open level ground by the sky, klx: the sum of L sin(e) over the solid angles cos(e) de da. */
  horizontalIlluminance(): [number, number, number] {
    const sum: [number, number, number] = [0, 0, 0];
    const stepElevation = Math.PI / 2 / (this.height - 1); // the half rows at zenith and horizon weigh nothing
    const stepAzimuth = (2 * Math.PI) / this.width;
    for (let row = 0; row < this.height; ++row) {
      const elevation = Math.PI / 2 - row * stepElevation;
      const weight = Math.sin(elevation) * Math.cos(elevation) * stepElevation * stepAzimuth;
      for (let column = 0; column < this.width; ++column) {
        const value = this.at(column, row);
        for (let c = 0 as 0 | 1 | 2; c < 3; ++c) sum[c] += weight * value[c];
      }
    }
    return sum;
  }

  /** Mean of the lowest row, kcd/m²: what far things fade into. */
  horizonMean(): [number, number, number] {
    const sum: [number, number, number] = [0, 0, 0];
    for (let column = 0; column < this.width; ++column) {
      const value = this.at(column, this.height - 1);
      for (let c = 0 as 0 | 1 | 2; c < 3; ++c) sum[c] += value[c] / this.width;
    }
    return sum;
  }
}

/** Luminance of far level ground under this sky and sun, kcd/m²: E ρ/π. The albedo of mixed land seen from afar. */
export function groundRadiance(skyKlx: Vec3, sunNormalKlx: Vec3, sunSinElevation: number): [number, number, number] {
  const albedo: Vec3 = [0.22, 0.215, 0.19]; // fields, streets and roofs from afar, greyed by haze; by eye
  const sine = Math.max(0, sunSinElevation);
  return [0, 1, 2].map((c) => ((albedo[c] ?? 0) / Math.PI) * ((skyKlx[c] ?? 0) + sine * (sunNormalKlx[c] ?? 0))) as [number, number, number];
}
