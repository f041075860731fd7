// The languages of the page.
import { expect, test } from 'vitest';
import { english } from '../../src/core/text/en';
import { german } from '../../src/core/text/de';
import { chooseLanguage } from '../../src/core/text/language';

test.each([
  [null, ['de-AT', 'en'], 'de'],
  [null, ['fr', 'en-GB'], 'en'],
  [null, ['fr', 'de'], 'de'],
  [null, [], 'en'],
  ['de', ['en'], 'de'],
  ['EN', ['de'], 'en'],
  ['xx', ['de'], 'de'],
] as const)('asked for %j, with a browser that wants %j, the page speaks %s', (asked, wanted, language) => expect(chooseLanguage(asked, wanted)).toBe(language));

/** Paths of all words that are the same in both tables. */
function same(a: unknown, b: unknown, path: string): string[] {
  if (typeof a === 'string') return a === b && /\p{L}{3}/u.test(a) ? [path] : [];
  if (typeof a !== 'object' || a === null) return [];
  return Object.entries(a).flatMap(([key, value]) => same(value, (b as Record<string, unknown>)[key], `${path}.${key}`));
}

test('nothing was left in English', () => expect(same(english, german, '')).toEqual([]));
