import { LoadError } from './load_error';
import { text } from './text';

/** What a city file says about one of its objects. */
export interface CityObject {
  id: string;
  type?: string;
  /** Index of the building that it is a part of. */
  part_of?: number;
  attributes?: Record<string, unknown>;
}

interface ObjectsFile {
  format: 'skybake-objects';
  version: 1;
  objects: CityObject[];
  surface_types: string[];
  chart_objects: number[];
  chart_surfaces: number[];
}

/** The object that a place of the city belongs to, from objects.json of a bake. */
export interface OwnerOfChart {
  object: CityObject;
  building: CityObject | null;
  surface: string;
}

export class CityObjects {
  private constructor(private readonly file: ObjectsFile) {}

  /** Throws LoadError when the file is not what the bake's description speaks of. */
  static parse(url: string, bytes: Uint8Array<ArrayBuffer>, charts: number): CityObjects {
    let file: ObjectsFile;
    try {
      file = JSON.parse(new TextDecoder().decode(bytes)) as ObjectsFile;
    } catch {
      throw new LoadError(url, text.error.notJson);
    }
    const isWhole = file?.format === 'skybake-objects' && file.version === 1 && Array.isArray(file.objects) && Array.isArray(file.surface_types) &&
      file.chart_objects?.length === charts && file.chart_surfaces?.length === charts;
    if (!isWhole) throw new LoadError(url, text.error.notObjects);
    return new CityObjects(file);
  }

  ownerOf(chart: number): OwnerOfChart | null {
    const { objects, chart_objects, chart_surfaces, surface_types } = this.file;
    const object = objects[chart_objects[chart] ?? -1];
    if (!object) return null;
    const building = object.part_of === undefined ? null : (objects[object.part_of] ?? null);
    return { object, building, surface: surface_types[chart_surfaces[chart] ?? -1] ?? 'unknown' };
  }
}
