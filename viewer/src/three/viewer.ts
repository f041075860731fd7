import * as THREE from 'three';
import type { Bake } from '../core/bake';
import type { Comparison } from '../core/comparison';
import type { FalseColour } from '../core/false_colour';
import type { OnBytes } from '../core/fetch';
import { wholeLight, type LightMix } from '../core/light_parts';
import type { Mode, Picture } from '../core/pictures';
import { worldToScene, type Vec3 } from '../core/units';
import { BakedScene } from './baked_scene';
import { BakePair, type Picked } from './bake_pair';
import { LayerPainter } from './layers';
import { finishDrawing, pngOf, readBlock } from './read_back';
import { statsOf, type ViewerStats } from './stats';
import { Steering } from './steering';

export interface ViewerOptions {
  antialias: boolean;
  onViewChange: () => void;
  onContextLost: () => void;
  /** A file that was asked for later cannot be shown. */
  onError: (error: unknown) => void;
}

/** Pictures with new pages follow each other no faster. */
const pageIntervalMs = 250;

/** Draws a bake. Positions at its surface are world metres (z up); inside all is the scene's frame (y up). */
export class Viewer {
  private readonly renderer: THREE.WebGLRenderer;
  private readonly camera = new THREE.PerspectiveCamera(60, 1, 0.2, 1000);
  private readonly resizeObserver: ResizeObserver;
  private readonly painter: LayerPainter;
  private steering: Steering | null = null;
  private pair: BakePair | null = null;
  private currentMix = wholeLight;
  private currentLayer: string | null = null;
  private currentPicture: Picture = 'lit';
  private currentEv = 0;
  private currentScale: FalseColour = { low: 100, high: 100_000, isLogarithmic: true };
  private isAirSeen = true;
  private frameRequest: number | null = null;
  private lastFrameMs: number | null = null;
  private drawSoon: number | null = null;
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
    this.painter = new LayerPainter(this.renderer);
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
    const baked = await this.openScene(bake, onBytes);
    this.pair = new BakePair(baked);
    this.steering = new Steering(baked, this.camera, this.canvas, () => this.changed());
  }

  private openScene(bake: Bake, onBytes: OnBytes): Promise<BakedScene> {
    return BakedScene.open(bake, this.painter, this.renderer.capabilities.getMaxAnisotropy(), onBytes, () => this.changedSoon());
  }

  /** Loads a second bake to compare with. Throws LoadError. */
  async openOther(bake: Bake, onBytes: OnBytes): Promise<void> {
    if (!this.pair) throw new Error('no city is open');
    this.pair.join(await this.openScene(bake, onBytes));
  }

  /** What is shown of two bakes, and where the divider stands, 0…1 from the left. */
  compare(comparison: Comparison, divider: number, differenceLx: number): void {
    this.pair?.compare(comparison, divider, differenceLx);
    this.changed();
  }

  /**
   * Loads and shows an instant, or the cross-fade of two neighbours for a moment between them; the very first is on show before all of its
   * pages are there. A later call overtakes an earlier one.
   * Returns false when it was overtaken. Throws LoadError.
   */
  async showMoment(moment: number, onBytes: OnBytes): Promise<boolean> {
    if (!this.pair) throw new Error('no city is open');
    if (!(await this.pair.showMoment(moment, this.camera.position, onBytes))) return false;
    this.applyDisplay();
    return true;
  }

  /** Number of the instant on show, between two of them while they fade; −1 before the first. */
  get moment(): number {
    return this.pair?.first.moment ?? -1;
  }

  /** Instants that are not at hand for a moment. */
  missingFor(moment: number): number[] {
    return this.pair?.first.missingFor(moment) ?? []; // the other bake's come along
  }

  /** Download size of what a moment still needs; null when a manifest does not list it. */
  bytesMissingFor(moment: number): number | null {
    return this.pair?.bytesMissingFor(moment) ?? null;
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
    return this.pair?.first.exposure ?? 1;
  }

  set toneMapping(name: 'agx' | 'none') {
    this.renderer.toneMapping = name === 'agx' ? THREE.AgXToneMapping : THREE.NoToneMapping;
    this.changed();
  }

  /** The surface at a place of the canvas, CSS pixels from its upper left corner, of the bake that is seen there; null where the sky is. */
  pick(x: number, y: number): Picked | null {
    return this.pair?.pick(this.rayAt(x, y), x / this.canvas.clientWidth) ?? null;
  }

  /** The same place of the other bake, where its surface is there, too. */
  pickTwin(picked: Picked): Picked | null {
    return this.pair?.pickTwin(picked) ?? null;
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
    return this.steering?.mode ?? 'orbit';
  }

  /** The view as world metres. */
  get view(): { position: Vec3; target: Vec3 } {
    return this.steered().view;
  }

  /** As Steering.flyTo(). */
  flyTo(position: Vec3, target: Vec3): void {
    this.steering?.flyTo(position, target);
  }

  /** Looks from a place at once. In walk mode the mode becomes orbit. */
  lookAt(position: Vec3, target: Vec3): void {
    this.steering?.lookAt(position, target);
  }

  /** As Steering.walkFrom(). */
  walkFrom(view: { position: Vec3; target: Vec3 } | null): boolean {
    return this.steering?.walkFrom(view) ?? false;
  }

  leaveWalk(): void {
    this.steering?.leaveWalk();
  }

  walkBy(along: number, aside: number, metres: number): void {
    this.steering?.walkBy(along, aside, metres);
  }

  /** How far a touch stick is pushed, forward and to the right, each −1…1. */
  steer(along: number, aside: number): void {
    this.steering?.steer(along, aside);
  }

  /** As Steering.goTo(). */
  goTo(place: readonly [number, number]): boolean {
    return this.steering?.goTo(place) ?? false;
  }

  /** The bake that was opened first. */
  get scene(): BakedScene | null {
    return this.pair?.first ?? null;
  }

  birdsEye(): { position: Vec3; target: Vec3 } {
    return this.steered().birdsEye();
  }

  heightOverGround(position: Vec3): number | null {
    return this.steering?.heightOverGround(position) ?? null;
  }

  stats(): ViewerStats {
    return statsOf(this.renderer.info, this.pair?.all ?? [], this.frames);
  }

  /** Draws now and waits for the graphics card; returns milliseconds. */
  drawNow(): number {
    const begun = performance.now();
    this.draw();
    finishDrawing(this.renderer.getContext());
    return performance.now() - begun;
  }

  /** Draws now; what is seen as a PNG. */
  picturePng(): Promise<Blob> {
    this.draw();
    return pngOf(this.canvas);
  }

  /** Draws now and reads a block of pixels, 0…255, from the upper left corner of the canvas in device pixels. */
  readPixels(x: number, y: number, width: number, height: number): Uint8Array {
    this.draw();
    return readBlock(this.renderer.getContext(), x, y, width, height);
  }

  private applyDisplay(): void {
    this.changed();
    const show = async (): Promise<void> => {
      const display = { picture: this.currentPicture, ev: this.currentEv, isAirSeen: this.isAirSeen, mix: this.currentMix, scale: this.currentScale, layer: this.currentLayer };
      for (const baked of this.pair?.all ?? []) await baked.show(display);
    };
    show().then(() => this.changed(), this.options.onError);
  }

  private steered(): Steering {
    if (!this.steering) throw new Error('no city is open');
    return this.steering;
  }

  /** Something changed: one frame is drawn, at most one a refresh of the screen. */
  private changed(): void {
    this.frameRequest ??= requestAnimationFrame((now) => this.frame(now));
  }

  /** The same for what comes in many small pieces, pages of light: a slow rasteriser would draw instead of loading. */
  private changedSoon(): void {
    this.drawSoon ??= window.setTimeout(() => {
      this.drawSoon = null;
      this.changed();
    }, pageIntervalMs);
  }

  private frame(now: number): void {
    this.frameRequest = null;
    const seconds = this.lastFrameMs === null ? 1 / 60 : (now - this.lastFrameMs) / 1000;
    this.lastFrameMs = now;
    const isMoving = this.steering?.update(seconds) ?? false;
    this.draw();
    this.options.onViewChange();
    if (isMoving) this.changed();
    else this.lastFrameMs = null;
  }

  private draw(): void {
    if (!this.pair || this.moment < 0) return; // no picture before the first light
    this.renderer.info.reset();
    this.pair.draw(this.renderer, this.camera, this.canvas.clientWidth, this.canvas.clientHeight);
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
    if (this.drawSoon !== null) clearTimeout(this.drawSoon);
    this.resizeObserver.disconnect();
    this.steering?.dispose();
    this.pair?.dispose();
    this.painter.dispose();
    this.renderer.dispose();
  }
}
