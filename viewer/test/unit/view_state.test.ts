import { expect, test } from 'vitest';
import { clampEv, exposureFactor } from '../../src/core/exposure';
import { formatViewState, parseViewState, type ViewState } from '../../src/core/view_state';

const state: ViewState = { mode: 'walk', position: [1.5, -2.25, 1.7], target: [3, 4, -0.5], picture: 'light', moment: 2.3, ev: -0.5, air: false, mix: { off: ['sun', 'lamps'], factors: { sun: 0.5, sky: 1, indirect: 1.25, lamps: 1 } }, layer: 'sun_hours_2026-03-21', scale: { low: 10, high: 5000, isLogarithmic: true }, comparison: { shown: 'swipe', divider: 0.25 } };

test('a link gives back what was sent', () => expect(parseViewState(formatViewState(state))).toEqual(state));

test('a link of before there was air shows it', () => expect(parseViewState('#v=1&m=walk')).toEqual({ mode: 'walk' }));

test.each([
  ['', {}],
  ['#', {}],
  ['#v=2&m=walk', {}],
  ['#v=1&m=swim&s=x-ray&i=-1&ev=much', {}],
  ['#v=1&p=1,2&t=0,0,0', {}],
  ['#v=1&p=1,2,3', {}],
  ['#v=1&p=1,two,3&t=0,0,0', {}],
  ['#v=1&m=orbit&i=3', { mode: 'orbit', moment: 3 }],
  ['#v=1&i=3&f=-0.40', { moment: 2.6 }],
  ['#v=1&i=3&f=7', { moment: 3 }],
  ['#v=1&fc=5,1,lin', {}],
  ['#v=1&c=both,0.5', {}],
  ['#v=1&c=a,1.5', {}],
  ['#v=1&fc=0,9,log', {}],
  ['#v=1&off=moon,lamps', { mix: { off: ['lamps'], factors: { sun: 1, sky: 1, indirect: 1, lamps: 1 } } }],
  ['#v=1&k=sun:0.5,moon:2,sky:9,lamps:x', { mix: { off: [], factors: { sun: 0.5, sky: 1, indirect: 1, lamps: 1 } } }],
  ['#v=1&l=../secret', {}],
])('of %j only what makes sense is taken', (hash, expected) => expect(parseViewState(hash)).toEqual(expected));

test('one stop doubles the exposure', () => {
  expect(exposureFactor(0.1, 1, 'lit') / exposureFactor(0.1, 0, 'lit')).toBeCloseTo(2, 12);
  expect(exposureFactor(0.2, 0, 'lit') / exposureFactor(0.1, 0, 'lit')).toBeCloseTo(2, 12);
});

test('the correction stays within its slider and on its steps', () => {
  expect(clampEv(99)).toBe(4);
  expect(clampEv(-99)).toBe(-4);
  expect(clampEv(0.04)).toBe(0);
});
