import * as THREE from 'three';
import type { OwnerOfChart } from '../core/objects';
import { measure } from '../core/measure';
import { domeOf, hoursInView, sunPath, type SunPoint } from '../core/obstruction';
import { formatInstant, utcOf } from '../core/moment';
import { text } from '../core/text';
import { language } from '../core/text/language';
import { sceneToWorld, worldToScene, type Vec3 } from '../core/units';
import { reflectanceAt } from '../three/reflectance';
import type { Picked, Viewer } from '../three/viewer';
import { element } from '../ui/element';
import { MeasurePanel, type Reading } from '../ui/measure_panel';
import { sunChart } from '../ui/sun_chart';

/** Rays to the sky begin this far off the surface, metres. */
const lift = 0.02;
const pathStepMinutes = 6;

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
}

/** Measures the place that is clicked: light, object, sun path. */
export class Measuring {
  readonly panel: MeasurePanel;
  readonly marker = element('div', { class: 'marker', hidden: '', 'aria-hidden': 'true' });
  last: Measured | null = null;
  private place: Vec3 | null = null;
  private question = 0;

  /**
   * @param tell shows a remark for a while
   * @param say for screen readers alone
   */
  constructor(
    private readonly viewer: Viewer,
    private readonly tell: (words: string) => void,
    private readonly say: (words: string) => void,
    private readonly onError: (error: unknown) => void,
  ) {
    this.panel = new MeasurePanel({ close: () => this.close(), copyPoint: () => void this.copyPoint() });
  }

  /** @param at CSS pixels from the canvas's upper left corner */
  async at(at: { x: number; y: number }, isByKey: boolean): Promise<void> {
    const picked = this.viewer.pick(at.x, at.y);
    if (!picked) {
      this.close();
      if (isByKey) this.tell(text.measure.nothing);
      return;
    }
    const question = ++this.question;
    this.place = this.viewer.worldOf(picked);
    this.moveMarker();
    this.panel.showReading(null, isByKey);
    try {
      const reading = await this.read(picked);
      if (question !== this.question) return;
      this.panel.showReading(reading);
      this.say(text.measure.announced(text.measure.lux(reading.lx)));
    } catch (error) {
      this.close();
      this.onError(error);
    }
  }

  get isOpen(): boolean {
    return !this.panel.root.hidden;
  }

  close(): void {
    ++this.question;
    this.place = null;
    this.marker.hidden = true;
    this.panel.hide();
  }

  /** Keeps the ring over the place as the view moves. */
  moveMarker(): void {
    const at = this.place && this.viewer.project(this.place);
    this.marker.hidden = !at;
    if (at) this.marker.style.transform = `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px)`;
  }

  private async copyPoint(): Promise<void> {
    if (!this.last) return;
    try {
      await navigator.clipboard.writeText(this.last.pointCsv);
      this.tell(text.measure.pointCopied);
    } catch {
      this.tell(text.linkNotCopied);
    }
  }

  private async read(picked: Picked): Promise<Reading> {
    const { baked: { bake, moment }, hit, surface } = picked;
    const { manifest } = bake;
    const instant = Math.round(moment);
    const { page, column, row, width, height } = texelOf(picked);
    const middle = sceneToWorld(surface.pointAt(new THREE.Vector2((column + 0.5) / width, (row + 0.5) / height)).toArray());
    const normal = sceneToWorld(hit.normal.toArray());
    const twin = this.viewer.pickTwin(picked);
    const [light, objects, twinLight] = await Promise.all([
      measure(bake, instant, page, column, row), bake.objects(), twin && lightAt(twin),
    ]);
    const owner = objects?.ownerOf(surface.chart) ?? null;
    const reflectance = reflectanceAt(surface);
    const onMap = middle.map((v, i) => v + (manifest.origin[i] ?? 0)) as [number, number, number];
    this.last = {
      instant, page, column, row, lx: light.total, skyViewFactor: light.skyViewFactor, reflectance, isFilled: light.isFilled,
      parts: Object.fromEntries(light.parts.map(({ part, lx }) => [part, lx])),
      id: owner?.object.id ?? null,
      building: owner?.building?.id ?? null,
      pointCsv: `id,x,y,z,nx,ny,nz\nmeasured,${onMap.map((v) => v.toFixed(4)).join(',')},${normal.map((v) => v.toFixed(6)).join(',')}\n`,
    };
    return {
      lx: light.total,
      parts: light.parts.map(({ part, lx }) => ({ name: text.partNames[part], lx })),
      facts: [
        ...(twinLight === null ? [] : [
          { name: this.viewer.isOther(picked) ? 'A' : 'B', value: text.measure.lux(twinLight) },
          { name: text.measure.change, value: text.measure.signedLux((this.viewer.isOther(picked) ? 1 : -1) * (light.total - twinLight)) },
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
      ...this.chartOf(picked, normal),
    };
  }

  private chartOf({ baked: { bake, rays, moment }, hit }: Picked, normal: Vec3): { chart: SVGElement; chartNote: string } {
    const { manifest } = bake;
    const origin = hit.point.clone().addScaledVector(hit.normal, lift);
    const isBlocked = (direction: Vec3): boolean => rays.first(origin, new THREE.Vector3(...worldToScene(direction))) !== null;
    const isFree = (direction: Vec3): boolean => direction[0] * normal[0] + direction[1] * normal[1] + direction[2] * normal[2] > 0 && !isBlocked(direction);
    const dome = domeOf(normal, isBlocked);
    const { sun } = bake.instant(Math.round(moment));
    const base = { dome, convergenceDeg: manifest.convergence_deg, sun: sun.shape === 'none' ? null : { azimuthDeg: sun.azimuth_deg, elevationDeg: sun.elevation_deg } };
    const utc = utcOf(manifest.instants, Math.round(moment));
    const { site } = manifest;
    if (!site || utc === null) return { chart: sunChart({ ...base, paths: [], hours: [], description: text.measure.noSite }), chartNote: text.measure.noSite };
    const year = new Date(utc).getUTCFullYear();
    const path = (at: number): SunPoint[] => sunPath(at, site, manifest.convergence_deg, pathStepMinutes);
    const today = path(utc);
    const label = bake.instant(Math.round(moment)).label;
    const zone = /([+-]\d{2}):?(\d{2})$/.exec(label);
    const offset = zone ? (Number(zone[1]) + Math.sign(Number(zone[1]) || 1) * Number(zone[2]) / 60) * 3_600_000 : 0;
    const hours = hoursInView(today, pathStepMinutes, isFree).toLocaleString(language, { maximumFractionDigits: 1 });
    const description = text.measure.sunPathText(hours, formatInstant(label).replace(/,?\s*\d{1,2}:\d{2}.*$/, ''));
    return {
      chart: sunChart({
        ...base,
        paths: [
          { points: path(Date.UTC(year, 5, 21, 12)), label: text.measure.june, isToday: false },
          { points: path(Date.UTC(year, 2, 20, 12)), label: text.measure.equinox, isToday: false },
          { points: path(Date.UTC(year, 11, 21, 12)), label: text.measure.december, isToday: false },
          { points: today, label: text.measure.today, isToday: true },
        ],
        hours: fullHours(sunPath(utc, site, manifest.convergence_deg, 1), offset),
        description,
      }),
      chartNote: description,
    };
  }
}

/** The texel of the lightmap that holds the place. */
function texelOf({ baked: { bake }, surface }: Picked): { page: number; column: number; row: number; width: number; height: number } {
  const page = Number((surface.mesh.userData as { page?: number }).page ?? 0);
  const { width, height } = bake.manifest.pages[page] ?? { width: 1, height: 1 };
  const column = Math.min(width - 1, Math.floor(surface.lightUv.x * width));
  return { page, column, row: Math.min(height - 1, Math.floor(surface.lightUv.y * height)), width, height };
}

async function lightAt(picked: Picked): Promise<number> {
  const { page, column, row } = texelOf(picked);
  return (await measure(picked.baked.bake, Math.round(picked.baked.moment), page, column, row)).total;
}

/** Every third hour of the local clock. */
function fullHours(path: readonly SunPoint[], offsetMs: number): { point: SunPoint; label: string }[] {
  const hour = 3_600_000;
  return path.flatMap((point) => {
    const clock = Math.round((point.utcMs + offsetMs) / 60_000) * 60_000;
    const of = (clock / hour) % 24;
    return Number.isInteger(of) && of % 3 === 0 ? [{ point, label: String(of) }] : [];
  });
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
