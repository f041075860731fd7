// Views that the user keeps: each is the part of an address that restores it, under a name. They stay in this browser, apart for each bake.
import type { Manifest } from './generated/manifest';

export interface SavedView {
  name: string;
  /** As formatViewState() writes it. */
  link: string;
}

const mostViews = 200;
const longestName = 80;

function isSavedView(value: unknown): value is SavedView {
  const view = value as Partial<SavedView> | null;
  return typeof view?.name === 'string' && view.name.length > 0 && view.name.length <= longestName && typeof view.link === 'string' && view.link.startsWith('#v=1&');
}

/** What makes sense of a list that comes from elsewhere. */
function viewsOf(data: unknown): SavedView[] {
  return Array.isArray(data) ? data.filter(isSavedView).slice(0, mostViews).map(({ name, link }) => ({ name, link })) : [];
}

/** Under which name a browser keeps the views of a bake: one web host may show many, one after the other at the same address. */
export function storageKey(path: string, { title, origin, bounds }: Manifest): string {
  return `skybake views ${path} ${title} ${[...origin, ...bounds.min, ...bounds.max].map((v) => v.toFixed(1)).join(',')}`;
}

/** The user's views; without storage (private windows, or when it is full) they last as long as the page. */
export class SavedViews {
  private views: SavedView[];

  /** @param storage null: none to be had */
  constructor(
    private readonly storage: Pick<Storage, 'getItem' | 'setItem'> | null,
    private readonly key: string,
  ) {
    this.views = this.read();
  }

  get list(): readonly SavedView[] {
    return this.views;
  }

  /** Keeps a view in place of one of the same name. False when it will be gone with the page. */
  save(name: string, link: string): boolean {
    return this.merge([{ name: name.trim().slice(0, longestName), link }]);
  }

  /** Takes over views that came with a link. False when they will be gone with the page. */
  merge(views: readonly SavedView[]): boolean {
    const names = new Set(views.map(({ name }) => name));
    this.views = [...this.views.filter(({ name }) => !names.has(name)), ...views].slice(-mostViews);
    return this.write();
  }

  delete(name: string): void {
    this.views = this.views.filter((view) => view.name !== name);
    this.write();
  }

  private read(): SavedView[] {
    try {
      return viewsOf(JSON.parse(this.storage?.getItem(this.key) ?? '[]'));
    } catch {
      return []; // storage is forbidden, or holds something else
    }
  }

  private write(): boolean {
    try {
      this.storage?.setItem(this.key, JSON.stringify(this.views));
      return this.storage !== null;
    } catch {
      return false; // full, or forbidden
    }
  }
}

/** The views as one field of a link: JSON in UTF-8, as base64url, which no program on the way escapes. */
export function encodeViews(views: readonly SavedView[]): string {
  const bytes = new TextEncoder().encode(JSON.stringify(views));
  return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join('')).replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
}

/** Whatever of it makes sense. */
export function decodeViews(field: string): SavedView[] {
  try {
    const bytes = Uint8Array.from(atob(field.replaceAll('-', '+').replaceAll('_', '/')), (c) => c.charCodeAt(0));
    return viewsOf(JSON.parse(new TextDecoder().decode(bytes)));
  } catch {
    return [];
  }
}
