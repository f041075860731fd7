import * as THREE from 'three';
import type { Bake, LampLight } from '../core/bake';
import { exposureFactor } from '../core/exposure';
import type { OnBytes } from '../core/fetch';
import type { LightPart } from '../core/light_parts';
import { LoadError } from '../core/load_error';
import type { Mode, Picture } from '../core/pictures';
import { text } from '../core/text';
import { sceneToWorld, worldToScene, type Vec3 } from '../core/units';
import { makeSharedUniforms, setPartsOff, setPicture } from './city_material';
import { loadCity, type City } from './city';
import { Ground } from './ground';
import { applyLight, makeLampTextures, makeLightTextures, type LightTextures } from './light';
import { OrbitMode } from './orbit';
import { SkyDome } from './sky';
import { WalkMode, type WalkKey } from './walk';

export interface ViewerOptions {
  antialias: boolean;
  onViewChange: () => void;
  onContextLost: () => void;
}

export interface ViewerStats {
  frames: number;
  drawCalls: number;
  triangles: number;
  textures: number;
  geometries: number;
}

const cityUri = 'city.glb';

/** Draws one bake. Positions at its surface are world metres (z up); inside all is the scene's frame (y up). */
export class Viewer {
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.PerspectiveCamera(60, 1, 0.2, 1000);
  private readonly shared = makeSharedUniforms();
  private readonly sky = new SkyDome(this.shared);
  private readonly resizeObserver: ResizeObserver;
  private orbit: OrbitMode | null = null;
  private walk: WalkMode | null = null;
  private ground: Ground | null = null;
  private city: City | null = null;
  private light: LightTextures | null = null;
  private lamps: LampLight | null = null;
  private lampTextures: THREE.Texture[] = [];
  private partsOff: readonly LightPart[] = [];
  private bake: Bake | null = null;
  private currentMode: Mode = 'orbit';
  private currentPicture: Picture = 'lit';
  private currentInstant = -1;
  private currentEv = 0;
  private isAirSeen = true;
  private requestedInstant = -1;
  private loading: AbortController | null = null;
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
    this.renderer.info.autoReset = true;
    this.scene.add(this.sky.mesh);
    canvas.addEventListener('webglcontextlost', (event) => {
      event.preventDefault();
      options.onContextLost();
    });
    this.resizeObserver = new ResizeObserver(() => this.resize());
    this.resizeObserver.observe(canvas);
    this.resize();
  }

  /** Loads the city; the light comes with showInstant(). Throws LoadError. */
  async open(bake: Bake, onBytes: OnBytes): Promise<void> {
    this.bake = bake;
    const bytes = await bake.fetch(cityUri, onBytes);
    const city = await loadCity(bake.url(cityUri), bytes, bake.manifest.pages, this.shared, this.renderer.capabilities.getMaxAnisotropy());
    if (city.chartCount > bake.manifest.charts) throw new LoadError(bake.url(cityUri), text.error.tooManyCharts(city.chartCount, bake.manifest.charts));
    this.city = city;
    this.lamps = await bake.loadLamps(onBytes);
    if (this.lamps) {
      this.lampTextures = await makeLampTextures(this.lamps);
      city.pages.forEach((page, p) => (page.uLampPage.value = this.lampTextures[p] ?? null));
    }
    this.orbit = new OrbitMode(this.camera, this.canvas, city.bounds, () => this.changed());
    this.orbit.enabled = true;
    this.lookAt(this.birdsEye().position, this.birdsEye().target);
  }

  /**
   * Loads the light of an instant and shows it; the one before is freed. A later call overtakes an earlier one.
   * Returns false when it was overtaken. Throws LoadError.
   */
  async showInstant(index: number, onBytes: OnBytes): Promise<boolean> {
    const { bake, city } = this;
    if (!bake || !city) throw new Error('no city is open');
    if (index === this.currentInstant && this.requestedInstant === index) return true;
    this.loading?.abort();
    const loading = new AbortController();
    this.loading = loading;
    this.requestedInstant = index;
    try {
      const files = await bake.loadInstant(index, bake.manifest.charts, onBytes, loading.signal);
      const light = await makeLightTextures(files, this.lamps?.scales ?? null);
      if (loading.signal.aborted) {
        light.dispose();
        return false;
      }
      const instant = bake.instant(index);
      const old = this.light;
      this.light = light;
      applyLight(light, instant, this.shared, city.pages);
      this.sky.apply(light.panorama, files.panorama, instant, bake.manifest.bounds.min[2] ?? 0);
      old?.dispose();
      if (!city.group.parent) this.scene.add(city.group);
      this.currentInstant = index;
      this.shared.uHasAir.value = this.isAirSeen && this.hasAir;
      this.applyExposure();
      this.changed();
      return true;
    } catch (error) {
      if (loading.signal.aborted) return false;
      this.requestedInstant = this.currentInstant;
      throw error;
    }
  }

  get instant(): number {
    return this.currentInstant;
  }

  get picture(): Picture {
    return this.currentPicture;
  }

  set picture(picture: Picture) {
    this.currentPicture = picture;
    setPicture(this.shared, picture);
    this.applyExposure();
    this.changed();
  }

  /** Whether the air between the eye and the city is drawn, in bakes that know it. */
  get air(): boolean {
    return this.isAirSeen;
  }

  set air(isSeen: boolean) {
    this.isAirSeen = isSeen;
    this.shared.uHasAir.value = isSeen && this.hasAir;
    this.changed();
  }

  /** Whether the instant on show has air. */
  get hasAir(): boolean {
    return this.bake !== null && this.currentInstant >= 0 && this.bake.instant(this.currentInstant).air !== undefined;
  }

  /** Parts of the light that the city is shown without. */
  get off(): readonly LightPart[] {
    return this.partsOff;
  }

  set off(parts: readonly LightPart[]) {
    this.partsOff = parts;
    setPartsOff(this.shared, parts);
    this.changed();
  }

  get ev(): number {
    return this.currentEv;
  }

  set ev(ev: number) {
    this.currentEv = ev;
    this.applyExposure();
    this.changed();
  }

  /** The factor from kcd/m² to the tone mapper's input. */
  get exposure(): number {
    return this.shared.uExposure.value;
  }

  set toneMapping(name: 'agx' | 'none') {
    this.renderer.toneMapping = name === 'agx' ? THREE.AgXToneMapping : THREE.NoToneMapping;
    this.changed();
  }

  get mode(): Mode {
    return this.currentMode;
  }

  /** The view as world metres. */
  get view(): { position: Vec3; target: Vec3 } {
    const target = this.currentMode === 'walk' ? this.walk?.target : this.orbit?.target;
    return { position: sceneToWorld(this.camera.position.toArray()), target: sceneToWorld((target ?? new THREE.Vector3()).toArray()) };
  }

  /** Flies to a view. In walk mode the mode becomes orbit. */
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
    const { city, orbit } = this;
    if (!city || !orbit) return false;
    const walk = this.prepareWalk(city);
    const eye = new THREE.Vector3();
    let yaw = 0;
    let pitch = 0;
    if (view) {
      eye.fromArray(worldToScene(view.position));
      const gaze = new THREE.Vector3(...worldToScene(view.target)).sub(eye);
      yaw = Math.atan2(gaze.x, -gaze.z);
      pitch = Math.atan2(gaze.y, Math.hypot(gaze.x, gaze.z));
    } else {
      const target = orbit.target.clamp(city.bounds.min, city.bounds.max);
      const place = this.ground?.openPlaceNear(target.x, target.z);
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

  pressWalkKey(key: WalkKey, isDown: boolean): void {
    if (this.currentMode === 'walk') this.walk?.press(key, isDown);
  }

  /** A view of the whole city from the side that the first instant's sun lights. */
  birdsEye(): { position: Vec3; target: Vec3 } {
    if (!this.city || !this.bake) return { position: [0, -1, 1], target: [0, 0, 0] };
    const size = this.city.bounds.getSize(new THREE.Vector3());
    const center = this.city.bounds.getCenter(new THREE.Vector3());
    const radius = 0.5 * Math.hypot(size.x, size.z);
    const sun = this.bake.manifest.instants[0]?.sun.direction ?? [0, -1, 1];
    // From the sun's side, but a third of a right angle off: walls are lit and shadows still show.
    const azimuth = Math.atan2(sun[0], sun[1]) + Math.PI / 6;
    const elevation = THREE.MathUtils.degToRad(32);
    const distance = 1.35 * radius;
    const target = new THREE.Vector3(center.x, this.city.bounds.min.y + Math.min(0.5 * size.y, 10), center.z);
    const position = target.clone().add(new THREE.Vector3(
      Math.sin(azimuth) * Math.cos(elevation) * distance, Math.sin(elevation) * distance, -Math.cos(azimuth) * Math.cos(elevation) * distance));
    return { position: sceneToWorld(position.toArray()), target: sceneToWorld(target.toArray()) };
  }

  /** How high a world position stands over what is below it; null above nothing. */
  heightOverGround(position: Vec3): number | null {
    if (!this.city) return null;
    this.prepareWalk(this.city);
    const point = new THREE.Vector3(...worldToScene(position));
    const below = this.ground?.below(point);
    return below ? point.y - below.y : null;
  }

  stats(): ViewerStats {
    const { render, memory } = this.renderer.info;
    return { frames: this.frames, drawCalls: render.calls, triangles: this.city?.triangleCount ?? 0, textures: memory.textures, geometries: memory.geometries };
  }

  /** Draws now and waits for the graphics card; returns milliseconds. */
  drawNow(): number {
    const begun = performance.now();
    this.draw();
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    return performance.now() - begun;
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

  private prepareWalk(city: City): WalkMode {
    if (!this.ground) this.ground = Ground.build(city);
    if (!this.walk) {
      const size = city.bounds.getSize(new THREE.Vector3()).length();
      this.walk = new WalkMode(this.camera, this.canvas, this.ground, size, () => this.changed());
    }
    return this.walk;
  }

  private applyExposure(): void {
    if (!this.bake || this.currentInstant < 0) return;
    this.shared.uExposure.value = exposureFactor(this.bake.instant(this.currentInstant).exposure_hint, this.currentEv, this.currentPicture);
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
    if (!this.light) return; // no picture before the first light
    this.renderer.render(this.scene, this.camera);
    ++this.frames;
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
    this.loading?.abort();
    this.orbit?.dispose();
    this.walk?.dispose();
    this.city?.dispose();
    this.light?.dispose();
    for (const texture of this.lampTextures) texture.dispose();
    this.sky.dispose();
    this.renderer.dispose();
  }
}
