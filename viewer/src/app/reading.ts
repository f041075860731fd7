// What a place of the city says about itself: its light, its object, its layer of the study.
import * as THREE from 'three';
import { formatQuantity, titleOf, type Layer } from '../core/layer_colours';
import { measure } from '../core/measure';
import type { OwnerOfChart } from '../core/objects';
import { text } from '../core/text';
import { language } from '../core/text/language';
import { sceneToWorld, type Vec3 } from '../core/units';
import { reflectanceAt } from '../three/reflectance';
import type { Picked } from '../three/bake_pair';
import type { Reading } from '../ui/measure_panel';
import { sunPathOf } from './sun_path';

/** What was measured last, for tests and for the clipboard. */
export interface Measured {
  instant: number;
  page: number;
  column: number;
  row: number;
  lx: number;
  parts: Record<string, number>;
  skyViewFactor: number;
  reflectance: number;
  isFilled: boolean;
  id: string | null;
  building: string | null;
  /** Header and line of the CSV that `skybake probe` reads. */
  pointCsv: string;
  /** Of the study's layer on show; null where it has no number. */
  layer: { id: string; value: number | null } | null;
}

/** What the view around the place has to do with its numbers. */
export interface MeasureContext {
  /** The same place of the bake that is compared with. */
  twin: Picked | null;
  /** Id of the study's layer on show. */
  layer: string | null;
}

/** Reads the archives at the texel of a place. Throws LoadError. */
export async function readPlace(picked: Picked, { twin, layer: layerId }: MeasureContext): Promise<{ reading: Reading; measured: Measured }> {
  const { baked: { bake, moment }, hit, surface } = picked;
  const { manifest } = bake;
  const instant = Math.round(moment);
  const { page, column, row } = texelOf(picked);
  const middle = sceneToWorld(surface.pointAt(new THREE.Vector2(column + 0.5, row + 0.5)).toArray());
  const normal = sceneToWorld(hit.normal.toArray());
  const layer = bake.layer(layerId);
  const [light, objects, twinLight, value] = await Promise.all([
    measure(bake, instant, page, column, row), bake.objects(), twin && lightAt(twin), layer && layerAt(picked, layer),
  ]);
  const owner = objects?.ownerOf(surface.chart) ?? null;
  const reflectance = reflectanceAt(surface);
  const onMap = middle.map((v, i) => v + (manifest.origin[i] ?? 0)) as [number, number, number];
  const measured: Measured = {
    instant, page, column, row, lx: light.total, skyViewFactor: light.skyViewFactor, reflectance, isFilled: light.isFilled,
    parts: Object.fromEntries(light.parts.map(({ part, lx }) => [part, lx])),
    id: owner?.object.id ?? null,
    building: owner?.building?.id ?? null,
    layer: layer && { id: layer.id, value },
    pointCsv: `id,x,y,z,nx,ny,nz\nmeasured,${onMap.map((v) => v.toFixed(4)).join(',')},${normal.map((v) => v.toFixed(6)).join(',')}\n`,
  };
  const reading: Reading = {
    layer: layer && { name: titleOf(layer, false), value: value === null ? text.measure.noValue : formatQuantity(layer, value) },
    lx: light.total,
    parts: light.parts.map(({ part, lx }) => ({ name: text.partNames[part], lx })),
    facts: [
      ...(twinLight === null ? [] : [
        { name: picked.isOther ? 'A' : 'B', value: text.measure.lux(twinLight) },
        { name: text.measure.change, value: text.measure.signedLux((picked.isOther ? 1 : -1) * (light.total - twinLight)) },
      ]),
      ...factsOf(owner),
      { name: text.measure.skyView, value: light.skyViewFactor.toLocaleString(language, { maximumFractionDigits: 3 }) },
      { name: text.measure.reflectance, value: reflectance.toLocaleString(language, { maximumFractionDigits: 2 }) },
      { name: text.measure.orientation, value: orientationOf(normal, manifest.convergence_deg) },
      { name: text.measure.place, value: onMap.map((v) => v.toLocaleString(language, { maximumFractionDigits: 1 })).join(' · ') },
    ],
    attributes: attributesOf(owner),
    notes: [
      ...(light.isFilled ? [text.measure.filled] : []),
      ...(Number.isInteger(moment) ? [] : [text.measure.between]),
      ...(owner ? [] : [text.measure.noObjects]),
    ],
    ...sunPathOf(picked, normal),
  };
  return { reading, measured };
}

/** The texel of the lightmap that holds the place. */
function texelOf({ baked: { bake }, surface: { page, texel } }: Picked): { page: number; column: number; row: number } {
  const { width, height } = bake.manifest.pages[page] ?? { width: 1, height: 1 };
  return { page, column: Math.min(width - 1, Math.floor(texel.x)), row: Math.min(height - 1, Math.floor(texel.y)) };
}

async function lightAt(picked: Picked): Promise<number> {
  const { page, column, row } = texelOf(picked);
  return (await measure(picked.baked.bake, Math.round(picked.baked.moment), page, column, row)).total;
}

/** Null where the layer has no number: outside of every chart. */
async function layerAt(picked: Picked, layer: Layer): Promise<number | null> {
  const { page, column, row } = texelOf(picked);
  const file = await picked.baked.bake.layerFile(layer, page);
  const value = (await file.texel(column, row)).get('value');
  return value === undefined || Number.isNaN(value) ? null : value;
}

function factsOf(owner: OwnerOfChart | null): { name: string; value: string }[] {
  if (!owner) return [];
  const { object, building, surface } = owner;
  const isBuilding = object.type === 'building';
  return [
    ...(building ? [{ name: text.measure.building, value: building.id }, { name: text.measure.part, value: object.id }] : [{ name: isBuilding ? text.measure.building : text.measure.object, value: object.id }]),
    { name: text.measure.surface, value: text.surfaces[surface] ?? surface },
  ];
}

function attributesOf(owner: OwnerOfChart | null): { name: string; value: string }[] {
  const all = { ...owner?.building?.attributes, ...owner?.object.attributes };
  return Object.entries(all).map(([name, value]) => ({ name, value: typeof value === 'string' ? value : JSON.stringify(value) }));
}

function orientationOf(normal: Vec3, convergenceDeg: number): string {
  const tilt = (Math.asin(Math.min(1, Math.max(-1, normal[2]))) * 180) / Math.PI;
  if (tilt > 85) return text.measure.up;
  if (tilt < -85) return text.measure.down;
  const azimuth = (Math.atan2(normal[0], normal[1]) * 180) / Math.PI + convergenceDeg;
  return text.measure.faces(text.measure.compass[Math.round(((azimuth + 360) % 360) / 45) % 8] ?? '', tilt);
}
