import { Bake } from '../core/bake';
import { distinguish, folderOf, type Comparison } from '../core/comparison';
import { LoadError } from '../core/load_error';
import { text } from '../core/text';
import type { Viewer } from '../three/viewer';
import { CompareBar } from '../ui/compare_bar';
import type { ProgressNotice } from '../ui/notices';

export interface Shown {
  shown: Comparison;
  divider: number;
}

/** A second bake beside the first: which of them is seen, and where the divider stands. */
export class Comparing {
  private readonly bar: CompareBar;
  private state: Shown = { shown: 'swipe', divider: 0.5 };

  private constructor(names: { a: string; b: string }, private readonly onChange: () => void) {
    this.bar = new CompareBar(names, {
      show: (shown) => this.set({ ...this.state, shown }),
      divide: (divider) => this.set({ ...this.state, divider }),
    });
    document.body.classList.add('compares');
  }

  /** Loads the bake to compare with. Throws LoadError. */
  static async open(url: URL, own: Bake, viewer: Viewer, progress: ProgressNotice, onChange: () => void): Promise<Comparing> {
    if (url.origin !== location.origin) throw new LoadError(url.href, text.error.otherOrigin);
    progress.begin(text.loading(text.compare.part), null);
    const other = await Bake.load(url.href, progress.advance);
    if (other.manifest.instants.length === 0) throw new LoadError(url.href, text.error.noInstants);
    progress.begin(text.loading(text.compare.part), other.bytesOf('city.glb'));
    await viewer.openOther(other, progress.advance);
    return new Comparing(namesOf(own, other), onChange);
  }

  get roots(): HTMLElement[] {
    return [this.bar.root, this.bar.divider];
  }

  get shown(): Shown {
    return this.state;
  }

  set(state: Shown): void {
    this.state = state;
    this.onChange();
  }

  changeSides(): void {
    this.set({ ...this.state, shown: this.state.shown === 'b' ? 'a' : 'b' });
  }

  swipeOrDifference(): void {
    this.set({ ...this.state, shown: this.state.shown === 'swipe' ? 'difference' : 'swipe' });
  }

  /** @param rangeLx at which a difference has its full colour */
  show(viewer: Viewer, rangeLx: number): void {
    const { shown, divider } = this.state;
    this.bar.update(shown, divider);
    viewer.compare(shown, divider, rangeLx);
  }
}

/** Names that tell the bakes apart. `skybake view` says in the address how their folders are called (a, b): it serves them below other names. */
function namesOf(own: Bake, other: Bake): { a: string; b: string } {
  const asked = new URLSearchParams(location.search);
  const named = (bake: Bake, said: string | null) => ({ manifest: bake.manifest, folder: said ?? folderOf(bake.manifestUrl) });
  return distinguish(named(own, asked.get('a')), named(other, asked.get('b'))) ?? text.compare.namesakes;
}
