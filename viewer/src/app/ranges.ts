import type { Bake } from '../core/bake';
import { autoScale, skyViewScale, type FalseColour } from '../core/false_colour';
import type { Picture } from '../core/pictures';
import { luminance } from '../core/units';

/** Ranges of the false colours: the user's, or those that suit the light. */
export class Ranges {
  private readonly chosen = new Map<Picture, FalseColour>();

  choose(picture: Picture, scale: FalseColour): void {
    this.chosen.set(picture, scale);
  }

  /** The user's range; null: none was chosen. */
  chosenFor(picture: Picture): FalseColour | null {
    return this.chosen.get(picture) ?? null;
  }

  of(picture: Picture, bake: Bake, moment: number): FalseColour {
    return this.chosenFor(picture) ?? (picture === 'sky-view' ? skyViewScale : luxScale(bake, moment));
  }
}

/** A range of lux that suits the moment. */
export function luxScale(bake: Bake, moment: number): FalseColour {
  const { exposure_hint: hint, sun } = bake.instant(Math.max(0, Math.round(moment)));
  return autoScale(hint, sun.shape === 'none' ? 0 : luminance(sun.normal_illuminance_klx));
}
