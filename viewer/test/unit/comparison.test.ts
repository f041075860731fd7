// Names that tell two bakes apart.
import { expect, test } from 'vitest';
import { distinguish, folderOf, type NamedBake } from '../../src/core/comparison';

const bake = (title: string, folder: string, file = 'town.city.json', settings: Record<string, string> = {}): NamedBake =>
  ({ manifest: { title, settings, inputs: [{ file, bytes: 1, sha256: '' }] }, folder });

test.each([
  ['titles', bake('old', 'x'), bake('new', 'y'), { a: 'old', b: 'new' }],
  ['folders of one title', bake('town', 'before'), bake('town', 'after'), { a: 'before', b: 'after' }],
  ['files, where the folder of one is not known', bake('town', ''), bake('town', 'compare', 'plan.city.json'), { a: 'town.city.json', b: 'plan.city.json' }],
  ['settings', bake('town', 'x', 'c', { '--sky': 'cie:1', '--texel': '1' }), bake('town', 'x', 'c', { '--sky': 'cie:12', '--texel': '1' }), { a: '--sky cie:1', b: '--sky cie:12' }],
  ['nothing', bake('town', 'x'), bake('town', 'x'), null],
] as const)('by their %s', (_, a, b, names) => expect(distinguish(a, b)).toEqual(names));

test('the folder of an address', () => {
  expect(folderOf('https://host/town/before%20it/manifest.json')).toBe('before it');
  expect(folderOf('http://127.0.0.1:8080/manifest.json')).toBe('');
});
