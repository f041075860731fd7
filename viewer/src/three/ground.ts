import * as THREE from 'three';
import type { CityRays } from './city_rays';

/** Height of the eye over the ground, metres. */
export const eyeHeight = 1.7;

const down = new THREE.Vector3(0, -1, 0);

/** What stands where, for feet and shoulders. Scene coordinates (y up). */
export class Ground {
  constructor(
    private readonly rays: CityRays,
    private readonly bounds: THREE.Box3,
  ) {}

  /** The first thing straight below a point, if there is any. */
  below(point: THREE.Vector3): { y: number; slope: number } | null {
    const hit = this.rays.first(point, down);
    return hit && { y: hit.point.y, slope: Math.abs(hit.normal.y) };
  }

  /** Free distance from a point in a unit direction, at most `limit` metres; and the normal of what stands there. */
  ahead(point: THREE.Vector3, direction: THREE.Vector3, limit: number): { distance: number; normal: THREE.Vector3 | null } {
    const hit = this.rays.first(point, direction, limit);
    return hit ? { distance: hit.distance, normal: hit.normal } : { distance: limit, normal: null };
  }

  /** The feet's place under (x, z) when it is walkable from `feetY`: no higher than a step above. Null off the world or at a wall. */
  feetAt(x: number, z: number, feetY: number, stepUp: number): number | null {
    return this.below(new THREE.Vector3(x, feetY + stepUp, z))?.y ?? null;
  }

  /**
   * An open place on the ground near a point, with a direction of long view: where a walk can begin.
   * The city's meshes do not say which of them are streets, so open ground is what lies low: within two metres and a slope of one in four of the
   * lowest surface about it, level, and with three metres free on all sides.
   */
  openPlaceNear(x: number, z: number): { feet: THREE.Vector3; yaw: number } | null {
    const top = this.bounds.max.y + 10;
    const size = this.bounds.getSize(new THREE.Vector3());
    const reach = Math.max(60, 0.5 * Math.hypot(size.x, size.z));
    const step = Math.max(4, reach / 60);
    const heights = new Map<string, { y: number; slope: number } | null>();
    const sample = (i: number, j: number) => {
      const key = `${i},${j}`;
      let found = heights.get(key);
      if (found === undefined) {
        found = this.below(new THREE.Vector3(x + i * step, top, z + j * step));
        heights.set(key, found);
      }
      return found;
    };
    const rings = Math.ceil(reach / step);
    const neighbours = Math.ceil(40 / step);
    for (let ring = 0; ring <= rings; ++ring) {
      for (const [i, j] of ringCells(ring)) {
        const here = sample(i, j);
        if (!here || here.slope < 0.9) continue;
        let isLow = true;
        for (let di = -neighbours; di <= neighbours && isLow; ++di) {
          for (let dj = -neighbours; dj <= neighbours && isLow; ++dj) {
            const there = sample(i + di, j + dj);
            if (there && here.y > there.y + 2 + 0.25 * step * Math.hypot(di, dj)) isLow = false;
          }
        }
        if (!isLow) continue;
        const feet = new THREE.Vector3(x + i * step, here.y, z + j * step);
        const eye = feet.clone().setY(feet.y + eyeHeight);
        let yaw = 0;
        let longest = 0;
        let narrowest = Infinity;
        for (let k = 0; k < 24; ++k) {
          const angle = (k / 24) * 2 * Math.PI;
          const gaze = new THREE.Vector3(Math.sin(angle), 0, -Math.cos(angle));
          narrowest = Math.min(narrowest, this.ahead(eye, gaze, 4).distance);
          // A view that ends at a house (a little above the eye's height) beats one that runs out of the model.
          const { distance } = this.ahead(eye, gaze.setY(0.1).normalize(), 100);
          const worth = distance >= 100 ? 5 : distance;
          if (worth > longest) {
            longest = worth;
            yaw = angle;
          }
        }
        if (narrowest >= 3) return { feet, yaw };
      }
    }
    return null;
  }
}

/** The cells at a Chebyshev distance, nearest to the centre first. */
function ringCells(ring: number): [number, number][] {
  if (ring === 0) return [[0, 0]];
  const cells: [number, number][] = [];
  for (let i = -ring; i <= ring; ++i) {
    cells.push([i, -ring], [i, ring]);
    if (Math.abs(i) < ring) cells.push([-ring, i], [ring, i]);
  }
  return cells.sort((a, b) => Math.hypot(...a) - Math.hypot(...b));
}
