import * as THREE from 'three';
import type { Bake } from '../core/bake';
import { momentOfOther, type Comparison } from '../core/comparison';
import type { FalseColour } from '../core/false_colour';
import type { OnBytes } from '../core/fetch';
import { wholeLight, type LightMix } from '../core/light_parts';
import type { Mode, Picture } from '../core/pictures';
import { sceneToWorld, worldToScene, type Vec3 } from '../core/units';
import { BakedScene } from './baked_scene';
import type { Hit, SurfacePoint } from './city_rays';
import { DifferencePass } from './difference';
import { OrbitMode } from './orbit';
import { WalkMode } from './walk';

export interface ViewerOptions {
  antialias: boolean;
  onViewChange: () => void;
  onContextLost: () => void;
  /** A file that was asked for later cannot be shown. */
  onError: (error: unknown) => void;
}

export interface ViewerStats {
  frames: number;
  drawCalls: number;
  triangles: number;
  textures: number;
  geometries: number;
  /** Of city.glb, before joining. */
  primitives: number;
  /** Lightmaps, and albedo textures, on the graphics card. */
  lightBytes: number;
  textureBytes: number;
}

/** What a click met: the surface of one of the bakes. Scene coordinates of that bake. */
export interface Picked {
  baked: BakedScene;
  hit: Hit;
  surface: SurfacePoint;
}

/** Draws a bake. Positions at its surface are world metres (z up); inside all is the scene's frame (y up). */
export class Viewer {
  private readonly renderer: THREE.WebGLRenderer;
  private readonly camera = new THREE.PerspectiveCamera(60, 1, 0.2, 1000);
  private readonly resizeObserver: ResizeObserver;
  private orbit: OrbitMode | null = null;
  private walk: WalkMode | null = null;
  private baked: BakedScene | null = null;
  private other: BakedScene | null = null;
  /** From the frame of the first bake into that of the other. */
  private readonly shift = new THREE.Vector3();
  private comparison: Comparison = 'swipe';
  private divider = 0.5;
  private differenceLx = 1;
  private difference: DifferencePass | null = null;
  private currentMix = wholeLight;
  private currentLayer: string | null = null;
  private currentMode: Mode = 'orbit';
  private currentPicture: Picture = 'lit';
  private currentEv = 0;
  private currentScale: FalseColour = { low: 100, high: 100_000, isLogarithmic: true };
  private isAirSeen = true;
  private frameRequest: number | null = null;
  private lastFrameMs: number | null = null;
  private frames = 0;

  /** Throws when the browser has no WebGL 2. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly options: ViewerOptions,
  ) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: options.antialias, powerPreference: 'high-performance' });
    this.renderer.outputColorSpace = THREE.SRGBColorSpace;
    // Of AgX, Khronos neutral and ACES the first keeps shadows that only the sky lights readable beside sunlit walls.
    this.renderer.toneMapping = THREE.AgXToneMapping;
    this.renderer.toneMappingExposure = 1; // the shaders multiply by uExposure themselves
    this.renderer.info.autoReset = false; // a frame may be two pictures
    canvas.addEventListener('webglcontextlost', (event) => {
      event.preventDefault();
      options.onContextLost();
    });
    this.resizeObserver = new ResizeObserver(() => this.resize());
    this.resizeObserver.observe(canvas);
    this.resize();
  }

  /** Loads the city; the light comes with showMoment(). Throws LoadError. */
  async open(bake: Bake, onBytes: OnBytes): Promise<void> {
    this.baked = await BakedScene.open(bake, this.renderer.capabilities.getMaxAnisotropy(), onBytes);
    this.orbit = new OrbitMode(this.camera, this.canvas, this.baked.city.bounds, () => this.changed());
    this.orbit.enabled = true;
    this.lookAt(this.birdsEye().position, this.birdsEye().target);
  }

  /** Loads a second bake to compare with. Throws LoadError. */
  async openOther(bake: Bake, onBytes: OnBytes): Promise<void> {
    if (!this.baked) throw new Error('no city is open');
    const other = await BakedScene.open(bake, this.renderer.capabilities.getMaxAnisotropy(), onBytes);
    other.exposedAs = this.baked;
    const [ownOrigin, otherOrigin] = [this.baked.bake.manifest.origin, bake.manifest.origin];
    this.shift.fromArray(worldToScene([0, 1, 2].map((i) => (ownOrigin[i] ?? 0) - (otherOrigin[i] ?? 0)) as unknown as Vec3));
    this.other = other;
  }

  /** What is shown of two bakes, and where the divider stands, 0…1 from the left. */
  compare(comparison: Comparison, divider: number, differenceLx: number): void {
    this.comparison = comparison;
    this.divider = divider;
    this.differenceLx = differenceLx;
    this.changed();
  }

  /**
   * Loads and shows an instant, or the cross-fade of two neighbours for a moment between them. A later call overtakes an earlier one.
   * Returns false when it was overtaken. Throws LoadError.
   */
  async showMoment(moment: number, onBytes: OnBytes): Promise<boolean> {
    if (!this.baked) throw new Error('no city is open');
    const { baked, other } = this;
    const shown = [baked.showMoment(moment, onBytes)];
    if (other) shown.push(other.showMoment(momentOfOther(baked.bake.manifest.instants, other.bake.manifest.instants, moment), onBytes));
    if ((await Promise.all(shown)).includes(false)) return false;
    this.applyDisplay();
    return true;
  }

  /** Number of the instant on show, between two of them while they fade; −1 before the first. */
  get moment(): number {
    return this.baked?.moment ?? -1;
  }

  /** Instants that are not at hand for a moment. */
  missingFor(moment: number): number[] {
    return this.baked?.missingFor(moment) ?? []; // the other bake's come along
  }

  get picture(): Picture {
    return this.currentPicture;
  }

  set picture(picture: Picture) {
    this.currentPicture = picture;
    this.applyDisplay();
  }

  /** Range of the false colours: lx, or the factor itself for the sky view. */
  get scale(): FalseColour {
    return this.currentScale;
  }

  set scale(scale: FalseColour) {
    this.currentScale = scale;
    this.applyDisplay();
  }

  /** Whether the air between the eye and the city is drawn, in bakes that know it. */
  get air(): boolean {
    return this.isAirSeen;
  }

  set air(isSeen: boolean) {
    this.isAirSeen = isSeen;
    this.applyDisplay();
  }

  /** How much of each part of the light is shown. */
  get mix(): LightMix {
    return this.currentMix;
  }

  set mix(mix: LightMix) {
    this.currentMix = mix;
    this.applyDisplay();
  }

  /** Id of the study's layer that the picture of that name shows. */
  get layer(): string | null {
    return this.currentLayer;
  }

  set layer(id: string | null) {
    this.currentLayer = id;
    this.applyDisplay();
  }

  get ev(): number {
    return this.currentEv;
  }

  set ev(ev: number) {
    this.currentEv = ev;
    this.applyDisplay();
  }

  /** The factor from kcd/m² to the tone mapper's input. */
  get exposure(): number {
    return this.baked?.exposure ?? 1;
  }

  set toneMapping(name: 'agx' | 'none') {
    this.renderer.toneMapping = name === 'agx' ? THREE.AgXToneMapping : THREE.NoToneMapping;
    this.changed();
  }

  /** The surface at a place of the canvas, CSS pixels from its upper left corner, of the bake that is seen there; null where the sky is. */
  pick(x: number, y: number): Picked | null {
    const { clientWidth } = this.canvas;
    const isOther = this.other !== null && (this.comparison === 'b' || (this.comparison === 'swipe' && x > this.divider * clientWidth));
    const baked = isOther ? this.other : this.baked;
    if (!baked) return null;
    const { origin, direction } = this.rayAt(x, y);
    if (isOther) origin.add(this.shift);
    return pickOf(baked, origin, direction);
  }

  /** The same place of the other bake, where its surface is there, too. */
  pickTwin({ baked, hit }: Picked): Picked | null {
    if (!this.other || !this.baked) return null;
    const twin = baked === this.baked ? this.other : this.baked;
    const shift = this.shift.clone().multiplyScalar(twin === this.other ? 1 : -1);
    const above = 0.05; // metres: closer than two surfaces of a city stand
    const found = pickOf(twin, hit.point.clone().add(shift).addScaledVector(hit.normal, above), hit.normal.clone().negate());
    return found && found.hit.distance < 2 * above ? found : null;
  }

  /** A point of a bake's scene as a world position of the first. */
  worldOf({ baked, hit }: Picked): Vec3 {
    const point = hit.point.clone();
    return sceneToWorld((baked === this.other ? point.sub(this.shift) : point).toArray());
  }

  isOther(picked: Picked): boolean {
    return picked.baked === this.other;
  }

  private rayAt(x: number, y: number): THREE.Ray {
    const raycaster = new THREE.Raycaster();
    this.camera.updateMatrixWorld();
    raycaster.setFromCamera(new THREE.Vector2((2 * x) / this.canvas.clientWidth - 1, 1 - (2 * y) / this.canvas.clientHeight), this.camera);
    return raycaster.ray;
  }

  /** Where a world position is on the canvas, CSS pixels; null behind the camera. */
  project(position: Vec3): { x: number; y: number } | null {
    this.camera.updateMatrixWorld();
    const point = new THREE.Vector3(...worldToScene(position)).project(this.camera);
    if (point.z > 1) return null;
    return { x: (0.5 + 0.5 * point.x) * this.canvas.clientWidth, y: (0.5 - 0.5 * point.y) * this.canvas.clientHeight };
  }

  get mode(): Mode {
    return this.currentMode;
  }

  /** The view as world metres. */
  get view(): { position: Vec3; target: Vec3 } {
    const target = this.currentMode === 'walk' ? this.walk?.target : this.orbit?.target;
    return { position: sceneToWorld(this.camera.position.toArray()), target: sceneToWorld((target ?? new THREE.Vector3()).toArray()) };
  }

  /** On the way to a view through the air. From walk mode it is there at once, in orbit. */
  flyTo(position: Vec3, target: Vec3): void {
    if (this.currentMode === 'walk' || !this.orbit) return this.lookAt(position, target);
    this.orbit.fly(new THREE.Vector3(...worldToScene(position)), new THREE.Vector3(...worldToScene(target)));
    this.changed();
  }

  /** Looks from a place at once. In walk mode the mode becomes orbit. */
  lookAt(position: Vec3, target: Vec3): void {
    this.leaveWalk();
    this.orbit?.look(new THREE.Vector3(...worldToScene(position)), new THREE.Vector3(...worldToScene(target)));
    this.changed();
  }

  /**
   * Sets foot on the ground: below `position` when given, else at the open place nearest to what the orbit looks at.
   * False when there is no ground to stand on; the mode is then unchanged.
   */
  walkFrom(view: { position: Vec3; target: Vec3 } | null): boolean {
    const { baked, orbit } = this;
    if (!baked || !orbit) return false;
    const walk = this.prepareWalk(baked);
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
    this.changed();
    return true;
  }

  /** Back into the air: from the walker's place, a little up and behind. */
  leaveWalk(): void {
    if (this.currentMode !== 'walk' || !this.walk || !this.orbit) return;
    const target = this.walk.target;
    const back = this.camera.position.clone().sub(target).setY(0).setLength(60);
    this.walk.enabled = false;
    this.currentMode = 'orbit';
    this.orbit.enabled = true;
    this.orbit.look(target.clone().add(back).setY(target.y + 35), target);
    this.changed();
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
    const { baked, orbit, walk } = this;
    if (!baked || !orbit) return false;
    const [sceneX, , sceneZ] = worldToScene([x, y, 0]);
    if (this.currentMode === 'walk' && walk) {
      const place = baked.ground.openPlaceNear(sceneX, sceneZ);
      return place !== null && walk.stand(place.feet.setY(place.feet.y + 1), walk.yaw, walk.pitch);
    }
    const below = baked.ground.below(new THREE.Vector3(sceneX, baked.city.bounds.max.y + 1, sceneZ));
    const target = new THREE.Vector3(sceneX, below?.y ?? orbit.target.y, sceneZ);
    orbit.fly(target.clone().add(this.camera.position).sub(orbit.target), target);
    this.changed();
    return true;
  }

  /** The bake that was opened first. */
  get scene(): BakedScene | null {
    return this.baked;
  }

  /** A view of the whole city from the side that the first instant's sun lights. */
  birdsEye(): { position: Vec3; target: Vec3 } {
    if (!this.baked) return { position: [0, -1, 1], target: [0, 0, 0] };
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
    const below = this.baked?.ground.below(point);
    return below ? point.y - below.y : null;
  }

  stats(): ViewerStats {
    const { render, memory } = this.renderer.info;
    const all = [this.baked, this.other].filter((baked) => baked !== null);
    const sum = (of: (baked: BakedScene) => number): number => all.reduce((total, baked) => total + of(baked), 0);
    return {
      frames: this.frames, drawCalls: render.calls, textures: memory.textures, geometries: memory.geometries,
      triangles: sum(({ city }) => city.triangleCount),
      primitives: sum(({ city }) => city.primitiveCount),
      lightBytes: sum(({ lightBytes }) => lightBytes),
      textureBytes: sum(({ city }) => city.textureBytes),
    };
  }

  /** Draws now and waits for the graphics card; returns milliseconds. */
  drawNow(): number {
    const begun = performance.now();
    this.draw();
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    return performance.now() - begun;
  }

  /** Draws now; what is seen as a PNG. */
  picturePng(): Promise<Blob> {
    this.draw();
    return new Promise((resolve, reject) => this.canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('no PNG'))), 'image/png'));
  }

  /** Draws now and reads a block of pixels, 0…255, from the upper left corner of the canvas in device pixels. */
  readPixels(x: number, y: number, width: number, height: number): Uint8Array {
    this.draw();
    const gl = this.renderer.getContext();
    const pixels = new Uint8Array(width * height * 4);
    gl.readPixels(x, gl.drawingBufferHeight - y - height, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    const topDown = new Uint8Array(pixels.length); // WebGL counts rows from below
    for (let row = 0; row < height; ++row) topDown.set(pixels.subarray(row * width * 4, (row + 1) * width * 4), (height - 1 - row) * width * 4);
    return topDown;
  }

  private prepareWalk({ city, ground }: BakedScene): WalkMode {
    const size = city.bounds.getSize(new THREE.Vector3()).length();
    return (this.walk ??= new WalkMode(this.camera, this.canvas, ground, size, () => this.changed()));
  }

  private applyDisplay(): void {
    this.changed();
    const show = async (): Promise<void> => {
      const display = { picture: this.currentPicture, ev: this.currentEv, isAirSeen: this.isAirSeen, mix: this.currentMix, scale: this.currentScale, layer: this.currentLayer };
      for (const baked of [this.baked, this.other]) await baked?.show(display);
    };
    show().then(() => this.changed(), this.options.onError);
  }

  /** Something changed: one frame is drawn, at most one a refresh of the screen. */
  private changed(): void {
    this.frameRequest ??= requestAnimationFrame((now) => this.frame(now));
  }

  private frame(now: number): void {
    this.frameRequest = null;
    const seconds = this.lastFrameMs === null ? 1 / 60 : (now - this.lastFrameMs) / 1000;
    this.lastFrameMs = now;
    const isMoving = this.currentMode === 'walk' ? (this.walk?.update(seconds) ?? false) : (this.orbit?.update(seconds) ?? false);
    this.draw();
    this.options.onViewChange();
    if (isMoving) this.changed();
    else this.lastFrameMs = null;
  }

  private draw(): void {
    if (!this.baked || this.moment < 0) return; // no picture before the first light
    this.renderer.info.reset();
    if (!this.other || this.other.moment < 0 || this.comparison === 'a') this.baked.draw(this.renderer, this.camera);
    else this.drawBoth(this.baked, this.other);
    ++this.frames;
  }

  private drawBoth(baked: BakedScene, other: BakedScene): void {
    const { renderer, camera } = this;
    camera.updateMatrixWorld();
    const otherCamera = camera.clone();
    otherCamera.position.add(this.shift);
    otherCamera.updateMatrixWorld();
    if (this.comparison === 'b') {
      other.draw(renderer, otherCamera);
    } else if (this.comparison === 'difference') {
      this.difference ??= new DifferencePass();
      this.difference.draw(renderer, this.differenceLx, (which) => (which === 0 ? baked.draw(renderer, camera, 'numbers') : other.draw(renderer, otherCamera, 'numbers')));
    } else {
      const { clientWidth, clientHeight } = this.canvas;
      const left = Math.round(this.divider * clientWidth);
      renderer.setScissorTest(true);
      renderer.setScissor(0, 0, left, clientHeight);
      baked.draw(renderer, camera);
      renderer.setScissor(left, 0, clientWidth - left, clientHeight);
      other.draw(renderer, otherCamera);
      renderer.setScissorTest(false);
    }
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.changed();
  }

  dispose(): void {
    if (this.frameRequest !== null) cancelAnimationFrame(this.frameRequest);
    this.resizeObserver.disconnect();
    this.orbit?.dispose();
    this.walk?.dispose();
    this.baked?.dispose();
    this.other?.dispose();
    this.difference?.dispose();
    this.renderer.dispose();
  }
}

function pickOf(baked: BakedScene, origin: THREE.Vector3, direction: THREE.Vector3): Picked | null {
  const hit = baked.rays.first(origin, direction);
  if (!hit) return null;
  if (hit.normal.dot(direction) > 0) hit.normal.negate(); // the side that is seen
  const surface = baked.rays.surfaceAt(hit);
  return surface && { baked, hit, surface };
}
