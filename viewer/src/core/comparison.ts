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
