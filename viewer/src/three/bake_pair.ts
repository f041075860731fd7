import * as THREE from 'three';
import { momentOfOther, type Comparison } from '../core/comparison';
import type { OnBytes } from '../core/fetch';
import { sceneToWorld, worldToScene, type Vec3 } from '../core/units';
import type { BakedScene } from './baked_scene';
import type { Hit, SurfacePoint } from './city_rays';
import { DifferencePass } from './difference';

/** What a click met: the surface of one of the bakes. Scene coordinates of that bake. */
export interface Picked {
  baked: BakedScene;
  hit: Hit;
  surface: SurfacePoint;
  /** Of the second of two bakes. */
  isOther: boolean;
  /** World position in the frame of the first bake. */
  world: Vec3;
}

/** The bake on show, alone or compared with another: what is drawn of them, and what a ray meets. */
export class BakePair {
  private second: BakedScene | null = null;
  /** From the frame of the first bake into that of the other. */
  private readonly shift = new THREE.Vector3();
  private comparison: Comparison = 'swipe';
  private divider = 0.5;
  private differenceLx = 1;
  private difference: DifferencePass | null = null;

  constructor(readonly first: BakedScene) {}

  /** Compares with a second bake from now on. */
  join(other: BakedScene): void {
    other.exposedAs = this.first;
    const [ownOrigin, otherOrigin] = [this.first.bake.manifest.origin, other.bake.manifest.origin];
    this.shift.fromArray(worldToScene([0, 1, 2].map((i) => (ownOrigin[i] ?? 0) - (otherOrigin[i] ?? 0)) as unknown as Vec3));
    this.second = other;
  }

  /** The bakes: one or two. */
  get all(): BakedScene[] {
    return this.second ? [this.first, this.second] : [this.first];
  }

  /** What is shown of two bakes, and where the divider stands, 0…1 from the left. */
  compare(comparison: Comparison, divider: number, differenceLx: number): void {
    this.comparison = comparison;
    this.divider = divider;
    this.differenceLx = differenceLx;
  }

  /** As BakedScene.showMoment(), with the other bake's instant that is nearest in time. */
  async showMoment(moment: number, eye: THREE.Vector3, onBytes: OnBytes): Promise<boolean> {
    const { first, second } = this;
    const shown = [first.showMoment(moment, eye, onBytes)];
    if (second) shown.push(second.showMoment(this.otherMoment(second, moment), eye.clone().add(this.shift), onBytes));
    return !(await Promise.all(shown)).includes(false);
  }

  /** Download size of what a moment still needs; null when a manifest does not list it. */
  bytesMissingFor(moment: number): number | null {
    const own = this.first.bytesMissingFor(moment);
    const others = this.second ? this.second.bytesMissingFor(this.otherMoment(this.second, moment)) : 0;
    return own === null || others === null ? null : own + others;
  }

  private otherMoment(second: BakedScene, moment: number): number {
    return momentOfOther(this.first.bake.manifest.instants, second.bake.manifest.instants, moment);
  }

  /** @param width of the canvas, CSS pixels, like `height` */
  draw(renderer: THREE.WebGLRenderer, camera: THREE.PerspectiveCamera, width: number, height: number): void {
    const { first, second, comparison } = this;
    if (!second || second.moment < 0 || comparison === 'a') {
      first.draw(renderer, camera);
      return;
    }
    camera.updateMatrixWorld();
    const otherCamera = camera.clone();
    otherCamera.position.add(this.shift);
    otherCamera.updateMatrixWorld();
    if (comparison === 'b') {
      second.draw(renderer, otherCamera);
    } else if (comparison === 'difference') {
      this.difference ??= new DifferencePass();
      this.difference.draw(renderer, this.differenceLx, (which) => (which === 0 ? first.draw(renderer, camera, 'numbers') : second.draw(renderer, otherCamera, 'numbers')));
    } else {
      const left = Math.round(this.divider * width);
      renderer.setScissorTest(true);
      renderer.setScissor(0, 0, left, height);
      first.draw(renderer, camera);
      renderer.setScissor(left, 0, width - left, height);
      second.draw(renderer, otherCamera);
      renderer.setScissorTest(false);
    }
  }

  /** What a ray in the frame of the first bake meets, of the bake that is seen at `place` (0…1 from the left); null where the sky is. */
  pick({ origin, direction }: THREE.Ray, place: number): Picked | null {
    const isOther = this.second !== null && (this.comparison === 'b' || (this.comparison === 'swipe' && place > this.divider));
    return this.pickOf(isOther, isOther ? origin.clone().add(this.shift) : origin, direction);
  }

  /** The same place of the other bake, where its surface is there, too. */
  pickTwin({ isOther, hit }: Picked): Picked | null {
    const shift = this.shift.clone().multiplyScalar(isOther ? -1 : 1);
    const above = 0.05; // metres: closer than two surfaces of a city stand
    const found = this.pickOf(!isOther, hit.point.clone().add(shift).addScaledVector(hit.normal, above), hit.normal.clone().negate());
    return found && found.hit.distance < 2 * above ? found : null;
  }

  private pickOf(isOther: boolean, origin: THREE.Vector3, direction: THREE.Vector3): Picked | null {
    const baked = isOther ? this.second : this.first;
    const hit = baked?.rays.first(origin, direction);
    if (!baked || !hit) return null;
    if (hit.normal.dot(direction) > 0) hit.normal.negate(); // the side that is seen
    const surface = baked.rays.surfaceAt(hit);
    const point = isOther ? hit.point.clone().sub(this.shift) : hit.point;
    return surface && { baked, hit, surface, isOther, world: sceneToWorld(point.toArray()) };
  }

  dispose(): void {
    for (const baked of this.all) baked.dispose();
    this.difference?.dispose();
  }
}
