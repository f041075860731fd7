import type { Bake } from '../core/bake';
import { decodeViews, encodeViews, SavedViews, storageKey, type SavedView } from '../core/saved_views';
import { text } from '../core/text';
import type { Vec3 } from '../core/units';
import type { Viewer } from '../three/viewer';

/** A view whose eye stands this low over the ground is meant to be walked from, metres. */
const highestWalker = 4;

type NamedView = { name: string; position: Vec3; target: Vec3 } | 'birds-eye' | 'on-foot';

/** The storage of this browser, where the user has not forbidden it. */
function storage(): Storage | null {
  try {
    return localStorage;
  } catch {
    return null;
  }
}

/** Places to look from: the bake's, and the user's own. */
export class Views {
  private readonly named: NamedView[];
  private readonly own: SavedViews;

  constructor(
    bake: Bake,
    private readonly viewer: Viewer,
    private readonly tell: (words: string) => void,
  ) {
    this.named = [...bake.manifest.views, 'birds-eye', 'on-foot'];
    this.own = new SavedViews(storage(), storageKey(new URL(bake.manifestUrl).pathname, bake.manifest));
  }

  get names(): string[] {
    return this.named.map((view) => (view === 'birds-eye' ? text.birdsEye : view === 'on-foot' ? text.onFoot : view.name));
  }

  get onFoot(): number {
    return this.named.indexOf('on-foot');
  }

  /** Shows one of the bake's views; false when there is none of that number. */
  show(index: number, isFlying: boolean): boolean {
    const view = this.named[index];
    if (view === undefined) return false;
    if (view === 'birds-eye') this.look(this.viewer.birdsEye(), isFlying);
    else if (view === 'on-foot') this.walk();
    else this.look(view, isFlying);
    return true;
  }

  private walk(): void {
    this.viewer.leaveWalk();
    if (!this.viewer.walkFrom(null)) this.tell(text.noGround);
  }

  /** On foot when the eye is near the ground. */
  private look({ position, target }: { position: Vec3; target: Vec3 }, isFlying: boolean): void {
    const height = this.viewer.heightOverGround(position);
    const isLow = height !== null && height >= 0 && height <= highestWalker;
    if (isLow && this.viewer.walkFrom({ position, target })) return;
    if (isFlying) this.viewer.flyTo(position, target);
    else this.viewer.lookAt(position, target);
  }

  get ownList(): readonly SavedView[] {
    return this.own.list;
  }

  ownLink(name: string): string | null {
    return this.own.list.find((view) => view.name === name)?.link ?? null;
  }

  /** @param link the part of the address that restores what is seen */
  save(name: string, link: string): void {
    this.tell(this.own.save(name, link) ? text.ownViews.saved(name.trim()) : text.ownViews.savedForNow(name.trim()));
  }

  delete(name: string): void {
    this.own.delete(name);
    this.tell(text.ownViews.deleted(name));
  }

  /** Takes over the views that an address brought along. */
  takeFrom(hash: string): void {
    const field = new URLSearchParams(hash.replace(/^#/, '')).get('w');
    if (field !== null) this.own.merge(decodeViews(field));
  }

  /** An address that brings all own views along. */
  withOwn(link: string): string {
    return `${link}&w=${encodeViews(this.own.list)}`;
  }
}
