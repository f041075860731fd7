import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

const flightSeconds = 1.4;

/** From one view to another: both ends of the gaze move, slowly at first and at last. */
interface Flight {
  from: { position: THREE.Vector3; target: THREE.Vector3 };
  to: { position: THREE.Vector3; target: THREE.Vector3 };
  share: number;
}

/** Flying about a point. Keeps the near plane in step with the distance, so that depth stays exact from a roof tile to the whole city. */
export class OrbitMode {
  private readonly controls: OrbitControls;
  private flight: Flight | null = null;

  constructor(
    private readonly camera: THREE.PerspectiveCamera,
    canvas: HTMLCanvasElement,
    private readonly bounds: THREE.Box3,
    onChange: () => void,
  ) {
    this.controls = new OrbitControls(camera, canvas);
    this.controls.enableDamping = !matchMedia('(prefers-reduced-motion: reduce)').matches;
    this.controls.dampingFactor = 0.12;
    this.controls.maxPolarAngle = THREE.MathUtils.degToRad(89); // never below the ground that is turned about
    this.controls.minDistance = 1;
    this.controls.zoomToCursor = true;
    this.controls.screenSpacePanning = false; // shifting glides over the ground
    this.controls.maxDistance = 8 * bounds.getSize(new THREE.Vector3()).length();
    this.controls.keyPanSpeed = 20;
    this.controls.listenToKeyEvents(canvas);
    this.controls.addEventListener('change', onChange);
    this.controls.addEventListener('start', () => (this.flight = null)); // the user's hand goes first
    this.controls.enabled = false;
  }

  set enabled(enabled: boolean) {
    this.flight = null;
    this.controls.enabled = enabled;
  }

  get target(): THREE.Vector3 {
    return this.controls.target.clone();
  }

  /** On the way to a view; at once for who wants no motion. */
  fly(position: THREE.Vector3, target: THREE.Vector3): void {
    if (matchMedia('(prefers-reduced-motion: reduce)').matches) return this.look(position, target);
    this.flight = { from: { position: this.camera.position.clone(), target: this.target }, to: { position, target }, share: 0 };
  }

  look(position: THREE.Vector3, target: THREE.Vector3): void {
    this.flight = null;
    this.jump(position, target);
  }

  private jump(position: THREE.Vector3, target: THREE.Vector3): void {
    this.camera.position.copy(position);
    this.controls.target.copy(target);
    // Damping would carry an old swing on into the new view.
    const { enableDamping } = this.controls;
    this.controls.enableDamping = false;
    this.controls.update();
    this.controls.enableDamping = enableDamping;
    this.fitDepth();
  }

  /** One step of the damped motion; true while it still moves. */
  update(seconds: number): boolean {
    if (!this.controls.enabled) return false;
    if (this.flight) return this.flyOn(this.flight, seconds);
    const isMoving = this.controls.update(seconds);
    this.fitDepth();
    return isMoving;
  }

  private flyOn(flight: Flight, seconds: number): boolean {
    flight.share = Math.min(1, flight.share + Math.min(seconds, 0.1) / flightSeconds);
    const share = THREE.MathUtils.smootherstep(flight.share, 0, 1);
    const { from, to } = flight;
    this.jump(from.position.clone().lerp(to.position, share), from.target.clone().lerp(to.target, share));
    if (flight.share === 1) this.flight = null;
    return true;
  }

  private fitDepth(): void {
    const distance = this.camera.position.distanceTo(this.controls.target);
    const sphere = this.bounds.getBoundingSphere(new THREE.Sphere());
    const near = Math.min(20, Math.max(0.2, distance / 100));
    const far = this.camera.position.distanceTo(sphere.center) + sphere.radius + 10;
    if (near === this.camera.near && far === this.camera.far) return;
    this.camera.near = near;
    this.camera.far = far;
    this.camera.updateProjectionMatrix();
  }

  dispose(): void {
    this.controls.dispose();
  }
}
