// Views that the user keeps.
import { expect, test } from 'vitest';
import type { Manifest } from '../../src/core/generated/manifest';
import { decodeViews, encodeViews, SavedViews, storageKey } from '../../src/core/saved_views';

const link = '#v=1&m=orbit&p=1.00,2.00,3.00&t=0.00,0.00,0.00';
const views = [{ name: 'Straße ☀ & <b>', link }, { name: 'b', link }];

function storage(): Pick<Storage, 'getItem' | 'setItem'> {
  const held = new Map<string, string>();
  return { getItem: (key) => held.get(key) ?? null, setItem: (key, value) => void held.set(key, value) };
}

test('a link gives back the views that were put in, whatever their names', () => {
  expect(decodeViews(encodeViews(views))).toEqual(views);
  expect(encodeViews(views)).toMatch(/^[A-Za-z0-9_-]+$/);
});

test.each(['', '!!!', 'e30', btoa('[1, {"name": "x"}, {"name": "", "link": "#v=1&"}, {"name": "x", "link": "https://elsewhere"}]')])('of %j nothing is taken', (field) => expect(decodeViews(field)).toEqual([]));

test('views stay in the storage, one of each name, apart for each bake', () => {
  const held = storage();
  const saved = new SavedViews(held, 'a');
  expect(saved.save(' one ', link)).toBe(true);
  saved.save('two', link);
  saved.save('one', `${link}&ev=1.0`);
  expect(new SavedViews(held, 'a').list.map(({ name }) => name)).toEqual(['two', 'one']);
  expect(new SavedViews(held, 'a').list[1]!.link).toContain('ev=1.0');
  expect(new SavedViews(held, 'b').list).toEqual([]);
  saved.delete('two');
  expect(new SavedViews(held, 'a').list.map(({ name }) => name)).toEqual(['one']);
});

test('without storage, or with a full or foreign one, views last as long as the page, and it is said', () => {
  const full = { getItem: () => '{"not": "ours"}', setItem: () => { throw new Error('full'); } };
  for (const bad of [null, full]) {
    const saved = new SavedViews(bad, 'a');
    expect(saved.save('one', link)).toBe(false);
    expect(saved.list).toHaveLength(1);
  }
});

test('two cities at one address have keys of their own', () => {
  const city = (title: string, x: number) => storageKey('/', { title, origin: [0, 0, 0], bounds: { min: [0, 0, 0], max: [x, 1, 1] } } as unknown as Manifest);
  expect(new Set([city('a', 1), city('b', 1), city('a', 2)]).size).toBe(3);
});
