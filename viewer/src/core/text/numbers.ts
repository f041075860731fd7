// Numbers as the page's language writes them.
import { language } from './language';

export function number(value: number, digits: number): string {
  if (Math.abs(value) < 0.5 * 10 ** -digits) value = 0; // no −0
  return new Intl.NumberFormat(language, { minimumFractionDigits: digits, maximumFractionDigits: digits }).format(value);
}

/** Four digits that count, and no more than tenths. */
export function significant(value: number): string {
  return new Intl.NumberFormat(language, value < 1000 ? { maximumFractionDigits: 1 } : { maximumSignificantDigits: 4 }).format(value);
}

export function formatBytes(bytes: number): string {
  return bytes < 1e6 ? `${number(bytes / 1e3, 0)} kB` : `${number(bytes / 1e6, 1)} MB`;
}

export function formatLength(metres: number): string {
  return metres >= 1 ? `${number(metres, metres % 1 === 0 ? 0 : 1)} m` : `${number(metres * 100, (metres * 100) % 1 < 0.05 ? 0 : 1)} cm`;
}

export function formatLuminance(kcdPerM2: number): string {
  if (kcdPerM2 >= 1) return `${number(kcdPerM2, 1)} kcd/m²`;
  const cd = kcdPerM2 * 1000;
  return `${number(cd, cd >= 10 ? 0 : 2)} cd/m²`;
}
