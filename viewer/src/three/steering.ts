import * as THREE from 'three';
import type { Mode } from '../core/pictures';
import { sceneToWorld, worldToScene, type Vec3 } from '../core/units';
import type { BakedScene } from './baked_scene';
import { OrbitMode } from './orbit';
import { WalkMode } from './walk';

/** Where the visitor is in a bake: flying about a point, or on foot. Positions at its surface are world metres (z up). */
export class Steering {
  private readonly orbit: OrbitMode;
  private walk: WalkMode | null = null;
  private currentMode: Mode = 'orbit';

  /** @param onChange the camera moved, or will */
  constructor(
    private readonly baked: BakedScene,
    private readonly camera: THREE.PerspectiveCamera,
    private readonly canvas: HTMLCanvasElement,
    private readonly onChange: () => void,
  ) {
    this.orbit = new OrbitMode(camera, canvas, baked.city.bounds, onChange);
    this.orbit.enabled = true;
    const { position, target } = this.birdsEye();
    this.lookAt(position, target);
  }

  get mode(): Mode {
    return this.currentMode;
  }

  /** The view as world metres. */
  get view(): { position: Vec3; target: Vec3 } {
    const target = this.currentMode === 'walk' && this.walk ? this.walk.target : this.orbit.target;
    return { position: sceneToWorld(this.camera.position.toArray()), target: sceneToWorld(target.toArray()) };
  }

  /** On the way to a view through the air. From walk mode it is there at once, in orbit. */
  flyTo(position: Vec3, target: Vec3): void {
    if (this.currentMode === 'walk') return this.lookAt(position, target);
    this.orbit.fly(new THREE.Vector3(...worldToScene(position)), new THREE.Vector3(...worldToScene(target)));
    this.onChange();
  }

  /** Looks from a place at once. In walk mode the mode becomes orbit. */
  lookAt(position: Vec3, target: Vec3): void {
    this.leaveWalk();
    this.orbit.look(new THREE.Vector3(...worldToScene(position)), new THREE.Vector3(...worldToScene(target)));
    this.onChange();
  }

  /**
   * Sets foot on the ground: below `position` when given, else at the open place nearest to what the orbit looks at.
   * False when there is no ground to stand on; the mode is then unchanged.
   */
  walkFrom(view: { position: Vec3; target: Vec3 } | null): boolean {
    const { baked, orbit } = this;
    const walk = this.prepareWalk();
    const eye = new THREE.Vector3();
    let yaw = 0;
    let pitch = 0;
    if (view) {
      eye.fromArray(worldToScene(view.position));
      const gaze = new THREE.Vector3(...worldToScene(view.target)).sub(eye);
      yaw = Math.atan2(gaze.x, -gaze.z);
      pitch = Math.atan2(gaze.y, Math.hypot(gaze.x, gaze.z));
    } else {
      const target = orbit.target.clamp(baked.city.bounds.min, baked.city.bounds.max);
      const place = baked.ground.openPlaceNear(target.x, target.z);
      if (!place) return false;
      eye.copy(place.feet).setY(place.feet.y + 1);
      yaw = place.yaw;
    }
    if (!walk.stand(eye, yaw, pitch)) return false;
    orbit.enabled = false;
    walk.enabled = true;
    this.currentMode = 'walk';
    this.onChange();
    return true;
  }

  /** Back into the air: from the walker's place, a little up and behind. */
  leaveWalk(): void {
    if (this.currentMode !== 'walk' || !this.walk) return;
    const target = this.walk.target;
    const back = this.camera.position.clone().sub(target).setY(0).setLength(60);
    this.walk.enabled = false;
    this.currentMode = 'orbit';
    this.orbit.enabled = true;
    this.orbit.look(target.clone().add(back).setY(target.y + 35), target);
    this.onChange();
  }

  /** Walks at once, without the passing of time (tests and the on-screen pad's single steps). */
  walkBy(along: number, aside: number, metres: number): void {
    if (this.currentMode === 'walk') this.walk?.walk(along, aside, metres);
  }

  /** How far a touch stick is pushed, forward and to the right, each −1…1. */
  steer(along: number, aside: number): void {
    if (this.currentMode === 'walk') this.walk?.steer(along, aside);
  }

  /** On foot: to the open place nearest to a world position, looking on in the same direction. In the air: on the way to above it. False when it cannot be reached. */
  goTo([x, y]: readonly [number, number]): boolean {
    const { orbit, walk, baked: { city, ground } } = this;
    const [sceneX, , sceneZ] = worldToScene([x, y, 0]);
    if (this.currentMode === 'walk' && walk) {
      const place = ground.openPlaceNear(sceneX, sceneZ);
      return place !== null && walk.stand(place.feet.setY(place.feet.y + 1), walk.yaw, walk.pitch);
    }
    const below = ground.below(new THREE.Vector3(sceneX, city.bounds.max.y + 1, sceneZ));
    const target = new THREE.Vector3(sceneX, below?.y ?? orbit.target.y, sceneZ);
    orbit.fly(target.clone().add(this.camera.position).sub(orbit.target), target);
    this.onChange();
    return true;
  }

  /** A view of the whole city from the side that the first instant's sun lights. */
  birdsEye(): { position: Vec3; target: Vec3 } {
    const { bounds } = this.baked.city;
    const size = bounds.getSize(new THREE.Vector3());
    const center = bounds.getCenter(new THREE.Vector3());
    const radius = 0.5 * Math.hypot(size.x, size.z);
    const sun = this.baked.bake.manifest.instants[0]?.sun.direction ?? [0, -1, 1];
    // From the sun's side, but a third of a right angle off: walls are lit and shadows still show.
    const azimuth = Math.atan2(sun[0], sun[1]) + Math.PI / 6;
    const elevation = THREE.MathUtils.degToRad(32);
    const distance = 1.35 * radius;
    const target = new THREE.Vector3(center.x, bounds.min.y + Math.min(0.5 * size.y, 10), center.z);
    const position = target.clone().add(new THREE.Vector3(
      Math.sin(azimuth) * Math.cos(elevation) * distance, Math.sin(elevation) * distance, -Math.cos(azimuth) * Math.cos(elevation) * distance));
    return { position: sceneToWorld(position.toArray()), target: sceneToWorld(target.toArray()) };
  }

  /** How high a world position stands over what is below it; null above nothing. */
  heightOverGround(position: Vec3): number | null {
    const point = new THREE.Vector3(...worldToScene(position));
    const below = this.baked.ground.below(point);
    return below ? point.y - below.y : null;
  }

  /** One step of the motion; true while it goes on. */
  update(seconds: number): boolean {
    return this.currentMode === 'walk' ? (this.walk?.update(seconds) ?? false) : this.orbit.update(seconds);
  }

  private prepareWalk(): WalkMode {
    const { city, ground } = this.baked;
    const size = city.bounds.getSize(new THREE.Vector3()).length();
    return (this.walk ??= new WalkMode(this.camera, this.canvas, ground, size, this.onChange));
  }

  dispose(): void {
    this.orbit.dispose();
    this.walk?.dispose();
  }
}
