import type { LightMix, LightPart } from '../core/light_parts';
import type { Mode, Picture } from '../core/pictures';
import type { SavedView } from '../core/saved_views';
import { text, texts } from '../core/text';
import { language, languages } from '../core/text/language';
import { element } from './element';
import { ExposureFields } from './panel/exposure_fields';
import { LightFields } from './panel/light_fields';
import { MoveFields } from './panel/move_fields';
import { PictureFields } from './panel/picture_fields';
import { TimeFields } from './panel/time_fields';
import { ViewFields, type ViewActions } from './panel/view_fields';

export interface PanelActions extends ViewActions {
  /** An instant, or a moment between two. */
  moment(moment: number): void;
  play(): void;
  picture(picture: Picture): void;
  layer(id: string): void;
  mode(mode: Mode): void;
  mouseLook(): void;
  ev(ev: number): void;
  air(isSeen: boolean): void;
  part(part: LightPart, isOn: boolean): void;
  factor(part: LightPart, factor: number): void;
  wholeLight(): void;
  map(isShown: boolean): void;
  help(): void;
}

export interface PanelState {
  moment: number;
  /** What the moment is called. */
  label: string;
  picture: Picture;
  /** Id of the study's layer that was chosen last. */
  layer: string | null;
  mode: Mode;
  ev: number;
  exposure: number;
  air: boolean;
  /** Parts of light that the instant has, and how much of them is shown. */
  parts: readonly LightPart[];
  mix: LightMix;
  isMapShown: boolean;
}

export interface PanelContent {
  title: string;
  instants: readonly string[];
  views: readonly string[];
  layers: readonly { id: string; title: string }[];
  texelM: number;
}

/** The settings, as plain labelled HTML. It shows what it is told; it decides nothing. */
export class Panel {
  readonly root: HTMLElement;
  readonly opener: HTMLButtonElement;
  private readonly time: TimeFields;
  private readonly picture: PictureFields;
  private readonly light: LightFields;
  private readonly move: MoveFields;
  private readonly view: ViewFields;
  private readonly exposure: ExposureFields;
  private readonly map = element('input', { type: 'checkbox', id: 'map' });

  constructor(content: PanelContent, actions: PanelActions) {
    this.time = new TimeFields(content.instants, actions);
    this.picture = new PictureFields(content.layers, actions);
    this.light = new LightFields(actions);
    this.move = new MoveFields(actions);
    this.view = new ViewFields(content.views, actions);
    this.exposure = new ExposureFields(actions);
    this.map.addEventListener('change', () => actions.map(this.map.checked));
    const help = element('button', { type: 'button', 'aria-label': text.help.open, title: `${text.help.open} (?)` }, ['?']);
    help.addEventListener('click', () => actions.help());
    const hide = element('button', { type: 'button', title: `${text.hidePanel} (H)` }, [text.hidePanel]);
    hide.addEventListener('click', () => this.show(false));
    this.opener = element('button', { type: 'button', class: 'open-panel', hidden: '' }, [text.showPanel]);
    this.opener.addEventListener('click', () => this.show(true));
    this.root = element('section', { class: 'panel', 'aria-label': text.panelLabel }, [
      element('header', {}, [element('h1', {}, [content.title]), element('div', { class: 'row' }, [help, hide])]),
      ...this.time.roots,
      this.picture.root,
      this.light.root,
      this.move.root,
      this.view.root,
      ...this.exposure.roots,
      element('fieldset', { class: 'field' }, [element('legend', {}, [text.map.name]), element('div', { class: 'row' }, [this.map, element('label', { for: 'map' }, [text.map.show])])]),
      element('p', { class: 'note' }, [text.baked(content.texelM)]),
      element('div', { class: 'field row' }, [element('label', { for: 'language' }, [text.language]), makeLanguages()]),
    ]);
  }

  show(isShown: boolean): void {
    const hadFocus = this.root.contains(document.activeElement) || document.activeElement === this.opener;
    this.root.hidden = !isShown;
    this.opener.hidden = isShown;
    document.body.classList.toggle('settings-hidden', !isShown);
    if (hadFocus) (isShown ? this.time.select : this.opener).focus();
  }

  get isShown(): boolean {
    return !this.root.hidden;
  }

  update(state: PanelState): void {
    this.time.update(state.moment, state.label);
    this.picture.update(state.picture, state.layer);
    this.light.update(state.parts, state.mix);
    this.move.update(state.mode);
    this.exposure.update(state);
    this.map.checked = state.isMapShown;
  }

  /** Marks the view that is shown, or none when the user moved on by themselves. */
  showView(index: number | null): void {
    this.view.showView(index);
  }

  showOwnViews(views: readonly SavedView[]): void {
    this.view.showOwn(views);
  }

  setAirNote(note: string | null): void {
    this.exposure.setAirNote(note);
  }

  showPlaying(isPlaying: boolean): void {
    this.time.showPlaying(isPlaying);
  }

  showSun(note: string): void {
    this.time.showSun(note);
  }
}

function makeLanguages(): HTMLSelectElement {
  const select = element('select', { id: 'language' }, languages.map((name) => element('option', { value: name, lang: name }, [texts[name].languageName])));
  select.value = language;
  select.addEventListener('change', () => {
    const address = new URL(location.href); // the part behind # restores the view
    address.searchParams.set('lang', select.value);
    location.assign(address);
  });
  return select;
}
