// Moments of a bake: whole numbers are its instants, what lies between is a cross-fade of two of them.
import type { Manifest } from './generated/manifest';
import { language } from './text/language';

/** Nearer to an instant than this, a moment is the instant. */
const snap = 0.03;

export function clampMoment(moment: number, instants: number): number {
  const clamped = Math.min(Math.max(moment, 0), instants - 1);
  return Math.abs(clamped - Math.round(clamped)) < snap ? Math.round(clamped) : clamped;
}

const isoPattern = /^(\d{4}-\d{2}-\d{2}T\d{2}:\d{2})(?::\d{2}(?:\.\d+)?)?(Z|[+-]\d{2}:?\d{2})$/;

/** Date and clock as the page's language writes them; what is no ISO 8601 instant stays as it is. */
export function formatInstant(label: string): string {
  const clock = isoPattern.exec(label)?.[1];
  if (!clock) return label;
  return new Intl.DateTimeFormat(language, { dateStyle: 'medium', timeStyle: 'short', timeZone: 'UTC' }).format(new Date(`${clock}Z`));
}

/** The date alone. */
export function formatDay(label: string): string {
  const clock = isoPattern.exec(label)?.[1];
  if (!clock) return label;
  return new Intl.DateTimeFormat(language, { dateStyle: 'medium', timeZone: 'UTC' }).format(new Date(`${clock}Z`));
}

function offsetMs(label: string): number {
  const zone = isoPattern.exec(label)?.[2] ?? 'Z';
  if (zone === 'Z') return 0;
  const digits = zone.replace(/\D/g, '');
  return (zone.startsWith('-') ? -1 : 1) * (Number(digits.slice(0, 2)) * 60 + Number(digits.slice(2))) * 60_000;
}

/** Milliseconds since 1970 of a moment; null where an instant was given as a direction of the sun. */
export function utcOf(instants: Manifest['instants'], moment: number): number | null {
  const first = instants[Math.floor(moment)]?.utc;
  const second = instants[Math.ceil(moment)]?.utc;
  if (first === undefined || second === undefined) return null;
  const blend = moment - Math.floor(moment);
  return (1 - blend) * Date.parse(first) + blend * Date.parse(second);
}

/** What the page calls a moment. */
export function momentLabel(instants: Manifest['instants'], moment: number): string {
  const first = instants[Math.floor(moment)]?.label ?? '';
  if (Number.isInteger(moment)) return formatInstant(first);
  const utc = utcOf(instants, moment);
  if (utc === null) return `${formatInstant(first)} – ${formatInstant(instants[Math.ceil(moment)]?.label ?? '')}`;
  return `≈ ${formatInstant(new Date(utc + offsetMs(first)).toISOString())}`;
}
