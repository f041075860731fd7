// Two bakes beside each other: what is shown of them.
import type { Manifest } from './generated/manifest';

/** The two with a divider, each alone, and what B has more or less than A. */
export const comparisons = ['swipe', 'a', 'b', 'difference'] as const;
export type Comparison = (typeof comparisons)[number];

export function isComparison(value: unknown): value is Comparison {
  return comparisons.some((known) => known === value);
}

/** The moment of `other` that belongs to one of `own`: of the same labels where there are such, else of the same place in the list. */
export function momentOfOther(own: Manifest['instants'], other: Manifest['instants'], moment: number): number {
  const twin = (index: number): number | null => {
    const found = other.findIndex(({ label }) => label === own[index]?.label);
    return found < 0 ? null : found;
  };
  const first = Math.floor(moment);
  const [a, b] = [twin(first), twin(Math.ceil(moment))];
  if (a !== null && Number.isInteger(moment)) return a;
  if (a !== null && b === a + 1) return a + moment - first;
  const nearest = twin(Math.round(moment));
  return nearest ?? Math.min(Math.round(moment), other.length - 1);
}

export interface NamedBake {
  manifest: Pick<Manifest, 'title' | 'inputs' | 'settings'>;
  /** Of the folder; empty when it is not known. */
  folder: string;
}

/** The shortest names that tell two bakes apart: their titles, folders, files or settings; null when nothing does. */
export function distinguish(a: NamedBake, b: NamedBake): { a: string; b: string } | null {
  const settings = (own: NamedBake, other: NamedBake): string =>
    Object.entries(own.manifest.settings).filter(([name, value]) => other.manifest.settings[name] !== value).map(([name, value]) => `${name} ${value}`).join(' ');
  const candidates: [string, string][] = [
    [a.manifest.title, b.manifest.title],
    [a.folder, b.folder],
    [a.manifest.inputs.map(({ file }) => file).join(', '), b.manifest.inputs.map(({ file }) => file).join(', ')],
    [settings(a, b), settings(b, a)],
  ];
  const found = candidates.find(([first, second]) => first !== second && first !== '' && second !== '');
  return found ? { a: found[0], b: found[1] } : null;
}

/** The last folder of an address, such as "before" of https://host/town/before/manifest.json. */
export function folderOf(manifestUrl: string): string {
  return decodeURIComponent(new URL(manifestUrl).pathname.split('/').at(-2) ?? '');
}
