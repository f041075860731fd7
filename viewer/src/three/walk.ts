import * as THREE from 'three';
import { eyeHeight, type Ground } from './ground';

const walkingSpeed = 2.5; // m/s: brisker than the 1.4 m/s of a real pedestrian, as visitors of a model expect
const runningFactor = 4;
const stepUp = 0.6; // kerbs and stairs, not sills
const shoulder = 0.4; // metres kept from walls
const turnPerPixel = 0.003;
const maxPitch = THREE.MathUtils.degToRad(85);
const stickRuns = 0.97; // pushed to its edge
const longestFrame = 0.1; // a stalled tab must not jump through a wall

export type WalkKey = 'forward' | 'back' | 'left' | 'right' | 'run';

const keyMap: Record<string, WalkKey> = {
  KeyW: 'forward', ArrowUp: 'forward',
  KeyS: 'back', ArrowDown: 'back',
  KeyA: 'left', ArrowLeft: 'left',
  KeyD: 'right', ArrowRight: 'right',
  ShiftLeft: 'run', ShiftRight: 'run',
};

/** On foot: clamped to the ground, stopped by walls, never off the edge of the world. Yaw is clockwise from north. */
export class WalkMode {
  yaw = 0;
  pitch = 0;
  private isEnabled = false;
  private readonly pressed = new Set<WalkKey>();
  /** Of the touch stick, each −1…1. */
  private readonly stick = { along: 0, aside: 0 };
  private readonly feet = new THREE.Vector3();
  private dragPointer: number | null = null;
  private lastX = 0;
  private lastY = 0;
  private readonly abort = new AbortController();

  constructor(
    private readonly camera: THREE.PerspectiveCamera,
    private readonly canvas: HTMLCanvasElement,
    private readonly ground: Ground,
    private readonly worldSize: number,
    private readonly onChange: () => void,
  ) {
    const options = { signal: this.abort.signal };
    canvas.addEventListener('pointerdown', (event) => this.beginDrag(event), options);
    canvas.addEventListener('pointermove', (event) => this.drag(event), options);
    for (const name of ['pointerup', 'pointercancel'] as const) canvas.addEventListener(name, (event) => this.endDrag(event), options);
    window.addEventListener('keydown', (event) => this.key(event, true), options);
    window.addEventListener('keyup', (event) => this.key(event, false), options);
    window.addEventListener('blur', () => this.pressed.clear(), options);
  }

  get enabled(): boolean {
    return this.isEnabled;
  }

  set enabled(enabled: boolean) {
    this.isEnabled = enabled;
    this.pressed.clear();
    this.steer(0, 0);
    this.dragPointer = null;
    if (!enabled) return;
    this.camera.near = 0.1;
    this.camera.far = Math.max(200, 2 * this.worldSize);
    this.camera.updateProjectionMatrix();
  }

  /** Puts the feet on the ground below the point, looking along yaw and pitch (radians). False when nothing is below. */
  stand(eye: THREE.Vector3, yaw: number, pitch: number): boolean {
    const feetY = this.ground.feetAt(eye.x, eye.z, eye.y, 0.2);
    if (feetY === null) return false;
    this.feet.set(eye.x, feetY, eye.z);
    this.yaw = yaw;
    this.pitch = THREE.MathUtils.clamp(pitch, -maxPitch, maxPitch);
    this.place();
    return true;
  }

  /** How far a touch stick is pushed, forward and to the right, each −1…1; all the way runs. */
  steer(along: number, aside: number): void {
    Object.assign(this.stick, { along, aside });
    this.onChange();
  }

  /** Walks for the time given; true while a key asks for more. */
  update(seconds: number): boolean {
    if (!this.isEnabled) return false;
    const along = Number(this.pressed.has('forward')) - Number(this.pressed.has('back')) + this.stick.along;
    const aside = Number(this.pressed.has('right')) - Number(this.pressed.has('left')) + this.stick.aside;
    const push = Math.min(1, Math.hypot(along, aside));
    if (push === 0) return false;
    const isRunning = this.pressed.has('run') || Math.hypot(this.stick.along, this.stick.aside) > stickRuns;
    this.walk(along, aside, Math.min(seconds, longestFrame) * walkingSpeed * (isRunning ? runningFactor : 1) * push);
    return true;
  }

  /** Walks `length` metres in the direction of (along, aside), sliding along walls. */
  walk(along: number, aside: number, length: number): void {
    const direction = new THREE.Vector3(
      along * Math.sin(this.yaw) + aside * Math.cos(this.yaw), 0, -along * Math.cos(this.yaw) + aside * Math.sin(this.yaw));
    if (direction.lengthSq() === 0) return;
    direction.normalize();
    // Pieces shorter than the shoulders are wide: no wall is stepped over.
    for (let left = length; left > 1e-6; left -= shoulder / 2) this.walkPiece(direction, Math.min(left, shoulder / 2));
    this.place();
  }

  private walkPiece(wanted: THREE.Vector3, length: number): void {
    const move = wanted.clone().multiplyScalar(length);
    for (let attempt = 0; attempt < 2; ++attempt) {
      const distance = move.length();
      if (distance < 1e-6) return;
      const wall = this.wallAhead(move.clone().divideScalar(distance), distance + shoulder);
      if (!wall) break;
      if (attempt === 1) return; // a corner
      move.addScaledVector(wall, -move.dot(wall));
    }
    const x = this.feet.x + move.x;
    const z = this.feet.z + move.z;
    const feetY = this.ground.feetAt(x, z, this.feet.y, stepUp);
    if (feetY === null) return; // the end of the world
    this.feet.set(x, feetY, z);
  }

  /** The level normal of a wall within reach at knee or eye height, turned against the movement. */
  private wallAhead(direction: THREE.Vector3, reach: number): THREE.Vector3 | null {
    for (const height of [stepUp + 0.05, eyeHeight]) {
      const from = this.feet.clone().setY(this.feet.y + height);
      const { normal } = this.ground.ahead(from, direction, reach);
      if (!normal || Math.abs(normal.y) > 0.8) continue; // a slope is walked, not run into
      normal.setY(0).normalize();
      return normal.dot(direction) > 0 ? normal.negate() : normal;
    }
    return null;
  }

  turn(yaw: number, pitch: number): void {
    this.yaw += yaw;
    this.pitch = THREE.MathUtils.clamp(this.pitch + pitch, -maxPitch, maxPitch);
    this.place();
  }

  /** A point ten metres ahead, for links. */
  get target(): THREE.Vector3 {
    return this.camera.position.clone().addScaledVector(this.viewDirection(), 10);
  }

  private viewDirection(): THREE.Vector3 {
    const level = Math.cos(this.pitch);
    return new THREE.Vector3(Math.sin(this.yaw) * level, Math.sin(this.pitch), -Math.cos(this.yaw) * level);
  }

  private place(): void {
    this.camera.position.copy(this.feet).setY(this.feet.y + eyeHeight);
    this.camera.up.set(0, 1, 0);
    this.camera.lookAt(this.camera.position.clone().add(this.viewDirection()));
    this.onChange();
  }

  private key(event: KeyboardEvent, isDown: boolean): void {
    const key = keyMap[event.code];
    if (!key) return;
    if (!isDown) {
      this.pressed.delete(key);
      return;
    }
    if (!this.isEnabled || event.ctrlKey || event.metaKey || event.altKey) return;
    // Arrow keys keep their meaning in sliders and lists.
    if (event.target instanceof Element && event.target.closest('input, select, textarea, dialog')) return;
    if (event.code.startsWith('Arrow')) event.preventDefault();
    this.pressed.add(key);
    this.onChange();
  }

  private beginDrag(event: PointerEvent): void {
    if (!this.isEnabled || this.dragPointer !== null || this.isMouseCaptured) return;
    this.dragPointer = event.pointerId;
    this.lastX = event.clientX;
    this.lastY = event.clientY;
    this.canvas.setPointerCapture(event.pointerId);
  }

  private get isMouseCaptured(): boolean {
    return document.pointerLockElement === this.canvas;
  }

  private drag(event: PointerEvent): void {
    if (this.isEnabled && this.isMouseCaptured) return this.turn(event.movementX * turnPerPixel, -event.movementY * turnPerPixel);
    if (event.pointerId !== this.dragPointer) return;
    this.turn(-(event.clientX - this.lastX) * turnPerPixel, (event.clientY - this.lastY) * turnPerPixel);
    this.lastX = event.clientX;
    this.lastY = event.clientY;
  }

  private endDrag(event: PointerEvent): void {
    if (event.pointerId === this.dragPointer) this.dragPointer = null;
  }

  dispose(): void {
    this.abort.abort();
  }
}
