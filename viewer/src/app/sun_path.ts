// The sun's ways over a measured place, and what stands in them.
import * as THREE from 'three';
import { formatDay, utcOf } from '../core/moment';
import { domeOf, hoursInView, sunPath, type SunPoint } from '../core/obstruction';
import { text } from '../core/text';
import { language } from '../core/text/language';
import { worldToScene, type Vec3 } from '../core/units';
import type { Picked } from '../three/bake_pair';
import { sunChart } from '../ui/sun_chart';

/** Rays to the sky begin this far off the surface, metres. */
const lift = 0.02;
const pathStepMinutes = 6;

/** @param normal of the surface, world frame */
export function sunPathOf({ baked: { bake, rays, moment }, hit }: Picked, normal: Vec3): { chart: SVGElement; chartNote: string } {
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
  const description = text.measure.sunPathText(hours, formatDay(label));
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

/** Every third hour of the local clock. */
function fullHours(path: readonly SunPoint[], offsetMs: number): { point: SunPoint; label: string }[] {
  const hour = 3_600_000;
  return path.flatMap((point) => {
    const clock = Math.round((point.utcMs + offsetMs) / 60_000) * 60_000;
    const of = (clock / hour) % 24;
    return Number.isInteger(of) && of % 3 === 0 ? [{ point, label: String(of) }] : [];
  });
}
