import type { App } from './app';
import type { FalseColour } from '../core/false_colour';
import { withFactor, withPartOn, type LightPart } from '../core/light_parts';
import type { Mode, Picture } from '../core/pictures';
import type { Vec3 } from '../core/units';
import type { Measured } from './reading';
import type { ViewerStats } from '../three/stats';

/**
 * `window.skybake`: what browser tests (and a curious console) hold on to. Positions are local world metres, z up.
 */
export interface TestHook {
  /** Resolves when the first picture is lit; rejects with the error that the page shows. */
  ready: Promise<void>;
  /** Loads and shows an instant; resolves when it is shown. */
  setInstant(index: number): Promise<void>;
  /** The same for a moment between two instants. */
  setMoment(moment: number): Promise<void>;
  setScale(scale: FalseColour): void;
  /** Measures at a place of the canvas, CSS pixels; null where the sky is. */
  measureAt(x: number, y: number): Promise<Measured | null>;
  setPicture(picture: Picture): void;
  setMode(mode: Mode): void;
  setAir(isSeen: boolean): void;
  /** Switches a part of the light on or off, or scales it. */
  setPart(part: LightPart, isOn: boolean): void;
  setFactor(part: LightPart, factor: number): void;
  /** Shows a layer of the study. */
  setLayer(id: string): void;
  /** Correction of the exposure, stops. */
  setExposure(ev: number): void;
  /** 'none' multiplies by the exposure and clips, so that a pixel can be computed by hand. */
  setToneMapping(name: 'agx' | 'none'): void;
  setCamera(position: Vec3, target: Vec3): void;
  /** Sets foot below `position`; false when nothing is there. */
  walkFrom(position: Vec3, target: Vec3): boolean;
  /** Walks at once, `along` and `aside` being −1, 0 or 1. */
  walk(along: number, aside: number, metres: number): void;
  /** Draws and waits for the graphics card; returns milliseconds. */
  renderFrame(): number;
  /** Draws and reads RGBA bytes; (0, 0) is the canvas's upper left corner, device pixels. */
  readPixels(x: number, y: number, width: number, height: number): number[];
  /** The factor from kcd/m² to the tone mapper's input. */
  exposure(): number;
  view(): { mode: Mode; position: Vec3; target: Vec3; moment: number; picture: Picture };
  stats(): ViewerStats;
}

declare global {
  interface Window {
    skybake?: TestHook;
  }
}

export function installTestHook(app: App, ready: Promise<void>): void {
  const { viewer } = app;
  window.skybake = {
    ready,
    setInstant: (index) => app.showMoment(index),
    setMoment: (moment) => app.showMoment(moment),
    setScale: (scale) => app.setScale(scale),
    measureAt: async (x, y) => {
      app.measuring.last = null;
      await app.measuring.at({ x, y }, false);
      return app.measuring.last;
    },
    setPicture: (picture) => app.setPicture(picture),
    setPart: (part, isOn) => app.setMix(withPartOn(viewer.mix, part, isOn)),
    setFactor: (part, factor) => app.setMix(withFactor(viewer.mix, part, factor)),
    setLayer: (id) => app.showLayer(id),
    setMode: (mode) => app.setMode(mode),
    setAir: (isSeen) => app.setAir(isSeen),
    setExposure: (ev) => app.setEv(ev),
    setToneMapping: (name) => (viewer.toneMapping = name),
    setCamera: (position, target) => viewer.lookAt(position, target),
    walkFrom: (position, target) => viewer.walkFrom({ position, target }),
    walk: (along, aside, metres) => viewer.walkBy(along, aside, metres),
    renderFrame: () => viewer.drawNow(),
    readPixels: (x, y, width, height) => Array.from(viewer.readPixels(x, y, width, height)),
    exposure: () => viewer.exposure,
    view: () => ({ mode: viewer.mode, ...viewer.view, moment: viewer.moment, picture: viewer.picture }),
    stats: () => viewer.stats(),
  };
}
