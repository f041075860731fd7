import { parseHalves } from './halves';

/** The sky as rows of RGBA half floats, kcd/m²: row 0 at the zenith, the last at the horizon, columns clockwise from grid north. */
export class Panorama {
  constructor(
    readonly width: number,
    readonly height: number,
    readonly halves: Uint16Array<ArrayBuffer>,
  ) {}

  static fromBytes(url: string, bytes: Uint8Array<ArrayBuffer>, width: number, height: number): Panorama {
    return new Panorama(width, height, parseHalves(url, bytes, width * height * 4));
  }
}
