import { shadePlan } from '../core/plan_shading';
import { text } from '../core/text';
import { heightsFromAbove } from '../three/plan';
import type { Viewer } from '../three/viewer';
import { Minimap } from '../ui/minimap';

/** Cells along the longer side of the plan. */
const planCells = 336;

/** The map: its plan is made once, when it is shown for the first time. */
export class MapCorner {
  private readonly minimap: Minimap;
  private isBegun = false;

  constructor(
    private readonly viewer: Viewer,
    convergenceDeg: number,
    tell: (words: string) => void,
    private readonly onChange: () => void,
  ) {
    this.minimap = new Minimap(convergenceDeg, {
      go: (place) => {
        if (!viewer.goTo(place)) tell(text.noGround);
        onChange();
      },
      hide: () => {
        this.show(false);
        onChange();
      },
    });
  }

  get root(): HTMLElement {
    return this.minimap.root;
  }

  get isShown(): boolean {
    return this.minimap.isShown;
  }

  show(isShown: boolean): void {
    this.minimap.show(isShown);
    document.body.classList.toggle('has-map', isShown);
    if (isShown && !this.isBegun) void this.draw();
  }

  /** The eye may have moved. */
  update(): void {
    const { position: [x, y], target } = this.viewer.view;
    this.minimap.update({ x, y, headingDeg: (Math.atan2(target[0] - x, target[1] - y) * 180) / Math.PI });
  }

  private async draw(): Promise<void> {
    const { scene } = this.viewer;
    if (!scene) return;
    this.isBegun = true;
    const heights = await heightsFromAbove(scene, planCells);
    const cellM = (heights.east - heights.west) / heights.columns;
    this.minimap.setPlan({ ...heights, pixels: shadePlan(heights, cellM) });
    this.onChange();
  }
}
