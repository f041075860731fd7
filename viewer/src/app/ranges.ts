import type { Bake } from '../core/bake';
import { autoScale, skyViewScale, type FalseColour } from '../core/false_colour';
import { scaleOf } from '../core/layer_colours';
import type { Picture } from '../core/pictures';
import { luminance } from '../core/units';

/** A picture, or a layer of the study. */
export interface Measure {
  picture: Picture;
  layer: string | null;
}

function keyOf({ picture, layer }: Measure): string {
  return picture === 'layer' ? `layer ${layer}` : picture;
}

/** Ranges of the false colours: the user's, or those that suit the light. */
export class Ranges {
  private readonly chosen = new Map<string, FalseColour>();

  choose(measure: Measure, scale: FalseColour): void {
    this.chosen.set(keyOf(measure), scale);
  }

  /** The user's range; null: none was chosen. */
  chosenFor(measure: Measure): FalseColour | null {
    return this.chosen.get(keyOf(measure)) ?? null;
  }

  of(measure: Measure, bake: Bake, moment: number): FalseColour {
    const layer = measure.picture === 'layer' ? bake.layer(measure.layer) : null;
    if (layer && (layer.edges || layer.kind === 'diverging')) return scaleOf(layer); // fixed
    return this.chosenFor(measure) ?? (layer ? scaleOf(layer) : measure.picture === 'sky-view' ? skyViewScale : luxScale(bake, moment));
  }
}

/** A range of lux that suits the moment. */
export function luxScale(bake: Bake, moment: number): FalseColour {
  const { exposure_hint: hint, sun } = bake.instant(Math.max(0, Math.round(moment)));
  return autoScale(hint, sun.shape === 'none' ? 0 : luminance(sun.normal_illuminance_klx));
}
