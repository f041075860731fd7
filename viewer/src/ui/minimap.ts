import { text } from '../core/text';
import { element } from './element';

/** A plan as a picture, and what part of the world it covers, metres of the grid. */
export interface Plan {
  pixels: Uint8ClampedArray<ArrayBuffer>;
  columns: number;
  rows: number;
  west: number;
  east: number;
  south: number;
  north: number;
}

export interface Whereabouts {
  x: number;
  y: number;
  /** Clockwise from grid north, degrees. */
  headingDeg: number;
}

const step = 0.04;
/** An eye beyond the map is shown this far from its edge. */
const rim = 0.04;

/** The city from above, with the place of the eye; a click goes there. Keyboard: arrows move a cross, Enter goes there. */
export class Minimap {
  readonly root: HTMLElement;
  private readonly area: HTMLElement;
  private readonly canvas = element('canvas', { 'aria-hidden': 'true' });
  private readonly eye = element('span', { class: 'eye', 'aria-hidden': 'true' });
  private readonly cross = element('span', { class: 'cross', 'aria-hidden': 'true', hidden: '' });
  private readonly north = element('span', { class: 'north', 'aria-hidden': 'true' }, [element('span', {}, ['▲']), element('span', {}, [text.map.north])]);
  private plan: Plan | null = null;
  private whereabouts: Whereabouts | null = null;
  private shownAt = '';
  private crossAt = { x: 0.5, y: 0.5 };

  /** @param convergenceDeg azimuth of grid north, clockwise from true north: the map has grid north on top */
  constructor(convergenceDeg: number, private readonly actions: { go(place: [number, number]): void; hide(): void }) {
    const hide = element('button', { type: 'button', 'aria-label': text.map.hide, title: `${text.map.hide} (N)` }, ['✕']);
    hide.addEventListener('click', () => actions.hide());
    this.area = element('div', { class: 'area', role: 'application', tabindex: '0', 'aria-label': text.map.label }, [this.canvas, this.eye, this.cross]);
    this.north.style.transform = `rotate(${(-convergenceDeg).toFixed(2)}deg)`;
    this.root = element('section', { class: 'minimap', 'aria-label': text.map.name, hidden: '' }, [this.area, this.north, hide]);
    this.area.addEventListener('click', (event) => {
      const box = this.area.getBoundingClientRect();
      this.go((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
    });
    this.area.addEventListener('keydown', (event) => this.key(event));
    this.area.addEventListener('blur', () => (this.cross.hidden = true));
  }

  get isShown(): boolean {
    return !this.root.hidden;
  }

  get hasPlan(): boolean {
    return this.plan !== null;
  }

  show(isShown: boolean): void {
    this.root.hidden = !isShown;
    this.place();
  }

  setPlan(plan: Plan): void {
    this.plan = plan;
    this.canvas.width = plan.columns;
    this.canvas.height = plan.rows;
    this.canvas.getContext('2d')?.putImageData(new ImageData(plan.pixels, plan.columns, plan.rows), 0, 0);
    this.area.style.aspectRatio = `${plan.columns} / ${plan.rows}`;
    this.area.classList.toggle('tall', plan.rows > plan.columns);
    this.shownAt = '';
    this.place();
  }

  /** Where the eye is; it costs nothing while that stays the same. */
  update(whereabouts: Whereabouts): void {
    this.whereabouts = whereabouts;
    if (this.isShown) this.place();
  }

  private place(): void {
    const { plan, whereabouts } = this;
    if (!plan || !whereabouts || !this.isShown) return;
    const share = (value: number, low: number, high: number): number => Math.min(1 - rim, Math.max(rim, (value - low) / (high - low)));
    const left = share(whereabouts.x, plan.west, plan.east);
    const top = 1 - share(whereabouts.y, plan.south, plan.north);
    const isOff = whereabouts.x < plan.west || whereabouts.x > plan.east || whereabouts.y < plan.south || whereabouts.y > plan.north;
    const at = `${(100 * left).toFixed(2)} ${(100 * top).toFixed(2)} ${whereabouts.headingDeg.toFixed(1)} ${isOff}`;
    if (at === this.shownAt) return;
    this.shownAt = at;
    this.eye.style.left = `${(100 * left).toFixed(2)}%`;
    this.eye.style.top = `${(100 * top).toFixed(2)}%`;
    this.eye.style.transform = `rotate(${whereabouts.headingDeg.toFixed(1)}deg)`;
    this.eye.classList.toggle('off', isOff);
    this.area.setAttribute('aria-description', text.map.eye(whereabouts.x, whereabouts.y, whereabouts.headingDeg));
  }

  private go(left: number, top: number): void {
    const { plan } = this;
    if (!plan) return;
    this.crossAt = { x: left, y: top };
    this.actions.go([plan.west + left * (plan.east - plan.west), plan.north - top * (plan.north - plan.south)]);
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const moves: Record<string, [number, number]> = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] };
    const move = moves[event.key];
    const isGo = event.key === 'Enter' || event.key === ' ';
    if (!move && !isGo) return;
    event.preventDefault();
    event.stopPropagation(); // arrows walk elsewhere
    if (isGo) return this.go(this.crossAt.x, this.crossAt.y);
    const clamped = (value: number): number => Math.min(1, Math.max(0, value));
    this.crossAt = { x: clamped(this.crossAt.x + (move?.[0] ?? 0)), y: clamped(this.crossAt.y + (move?.[1] ?? 0)) };
    this.cross.hidden = false;
    this.cross.style.left = `${(100 * this.crossAt.x).toFixed(2)}%`;
    this.cross.style.top = `${(100 * this.crossAt.y).toFixed(2)}%`;
  }
}
