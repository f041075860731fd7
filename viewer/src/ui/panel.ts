import { evRange } from '../core/exposure';
import { lightParts, type LightPart } from '../core/light_parts';
import { modes, pictures, type Mode, type Picture } from '../core/pictures';
import { text, texts } from '../core/text';
import { language, languages } from '../core/text/language';
import { element } from './element';

export interface PanelActions {
  /** An instant, or a moment between two. */
  moment(moment: number): void;
  picture(picture: Picture): void;
  mode(mode: Mode): void;
  view(index: number): void;
  ev(ev: number): void;
  copyLink(): void;
  savePicture(): void;
  play(): void;
  air(isSeen: boolean): void;
  part(part: LightPart, isOn: boolean): void;
}

export interface PanelState {
  moment: number;
  /** What the moment is called. */
  label: string;
  picture: Picture;
  mode: Mode;
  ev: number;
  exposure: number;
  air: boolean;
  /** Parts of light that the instant has, and those that are switched off. */
  parts: readonly LightPart[];
  off: readonly LightPart[];
}

export interface PanelContent {
  title: string;
  instants: readonly string[];
  views: readonly string[];
  texelM: number;
}

/** The settings, as plain labelled HTML. It shows what it is told; it decides nothing. */
export class Panel {
  readonly root: HTMLElement;
  readonly opener: HTMLButtonElement;
  private readonly instantSelect: HTMLSelectElement;
  private readonly instantSlider: HTMLInputElement;
  private readonly earlier: HTMLButtonElement;
  private readonly later: HTMLButtonElement;
  private readonly playButton: HTMLButtonElement;
  private readonly pictureButtons = new Map<Picture, HTMLButtonElement>();
  private readonly partButtons = new Map<LightPart, HTMLButtonElement>();
  private readonly modeButtons = new Map<Mode, HTMLButtonElement>();
  private readonly viewSelect: HTMLSelectElement;
  private readonly evSlider: HTMLInputElement;
  private readonly evLabel: HTMLElement;
  private readonly airSwitch: HTMLInputElement;
  private readonly airLabel: HTMLElement;
  private airNote: string | null = null;
  private readonly sunNote: HTMLElement;
  private readonly between: HTMLOptionElement;
  private shownMoment = 0;

  constructor(content: PanelContent, actions: PanelActions) {
    const last = content.instants.length - 1;
    this.between = element('option', { value: '', disabled: '', hidden: '' });
    this.instantSelect = element('select', { id: 'instant' }, [...content.instants.map((label, i) => element('option', { value: String(i) }, [label])), this.between]);
    this.instantSelect.addEventListener('change', () => actions.moment(Number(this.instantSelect.value)));
    this.instantSlider = element('input', { type: 'range', min: '0', max: String(last), step: '0.05', 'aria-label': text.instantSlider });
    this.instantSlider.addEventListener('input', () => actions.moment(Number(this.instantSlider.value)));
    this.earlier = element('button', { type: 'button', 'aria-label': text.previousInstant, title: `${text.previousInstant} (,)` }, ['‹']);
    this.later = element('button', { type: 'button', 'aria-label': text.nextInstant, title: `${text.nextInstant} (.)` }, ['›']);
    this.earlier.addEventListener('click', () => actions.moment(Math.ceil(this.shownMoment) - 1));
    this.later.addEventListener('click', () => actions.moment(Math.floor(this.shownMoment) + 1));
    this.playButton = element('button', { type: 'button', title: text.playHint }, [text.play]);
    this.playButton.addEventListener('click', () => actions.play());
    this.sunNote = element('p', { class: 'note' });

    const pictureGroup = element('div', { class: 'group wraps' }, pictures.map((picture, i) => {
      const button = element('button', { type: 'button', title: `${text.pictureHints[picture]} (${i + 1})` }, [text.pictures[picture]]);
      button.addEventListener('click', () => actions.picture(picture));
      this.pictureButtons.set(picture, button);
      return button;
    }));
    const partGroup = element('div', { class: 'group' }, lightParts.map((part) => {
      const button = element('button', { type: 'button', title: text.partHints[part] }, [text.partNames[part]]);
      button.addEventListener('click', () => actions.part(part, button.getAttribute('aria-pressed') !== 'true'));
      this.partButtons.set(part, button);
      return button;
    }));
    const modeGroup = element('div', { class: 'group' }, modes.map((mode) => {
      const button = element('button', { type: 'button', title: `${text.modeHints[mode]} (${mode === 'orbit' ? 'O' : 'P'})` }, [text.modes[mode]]);
      button.addEventListener('click', () => actions.mode(mode));
      this.modeButtons.set(mode, button);
      return button;
    }));

    this.viewSelect = element('select', { id: 'view' }, [
      element('option', { value: '', disabled: '' }, [text.freeView]),
      ...content.views.map((name, i) => element('option', { value: String(i) }, [name])),
    ]);
    this.viewSelect.addEventListener('change', () => actions.view(Number(this.viewSelect.value)));

    this.evSlider = element('input', { type: 'range', id: 'ev', min: String(evRange.min), max: String(evRange.max), step: String(evRange.step) });
    this.evSlider.addEventListener('input', () => actions.ev(Number(this.evSlider.value)));
    this.evLabel = element('span', { class: 'label' });
    const evReset = element('button', { type: 'button' }, [text.exposureReset]);
    evReset.addEventListener('click', () => actions.ev(0));

    const copyLink = element('button', { type: 'button', title: text.copyLinkHint }, [text.copyLink]);
    copyLink.addEventListener('click', () => actions.copyLink());
    const savePicture = element('button', { type: 'button', title: text.savePictureHint }, [text.savePicture]);
    savePicture.addEventListener('click', () => actions.savePicture());
    this.airSwitch = element('input', { type: 'checkbox', id: 'air', title: `${text.airHint} (F)` });
    this.airSwitch.addEventListener('change', () => actions.air(this.airSwitch.checked));
    this.airLabel = element('span', { class: 'label' });

    const hide = element('button', { type: 'button', title: `${text.hidePanel} (H)` }, [text.hidePanel]);
    hide.addEventListener('click', () => this.show(false));
    this.opener = element('button', { type: 'button', class: 'open-panel', hidden: '' }, [text.showPanel]);
    this.opener.addEventListener('click', () => this.show(true));

    const instantFields = [
      element('label', { for: 'instant' }, [text.instant]),
      element('div', { class: 'row' }, last > 0 ? [this.earlier, this.instantSelect, this.later] : [this.instantSelect]),
    ];
    this.root = element('section', { class: 'panel', 'aria-label': text.panelLabel }, [
      element('header', {}, [element('h1', {}, [content.title]), hide]),
      element('div', { class: 'field' }, last > 0 ? [...instantFields, element('div', { class: 'row below slim' }, [this.instantSlider, this.playButton])] : instantFields),
      this.sunNote,
      element('fieldset', { class: 'field' }, [element('legend', {}, [text.picture]), pictureGroup]),
      element('fieldset', { class: 'field' }, [element('legend', {}, [text.parts]), partGroup]),
      element('fieldset', { class: 'field' }, [element('legend', {}, [text.navigation]), modeGroup]),
      element('div', { class: 'field' }, [element('label', { for: 'view' }, [text.views]), element('div', { class: 'row' }, [this.viewSelect]), element('div', { class: 'row below' }, [copyLink, savePicture])]),
      element('div', { class: 'field' }, [
        element('label', { for: 'ev' }, [text.exposure]),
        element('div', { class: 'row' }, [this.evSlider, evReset]),
        this.evLabel,
      ]),
      element('fieldset', { class: 'field' }, [
        element('legend', {}, [text.air]),
        element('div', { class: 'row' }, [this.airSwitch, element('label', { for: 'air' }, [text.airSwitch])]),
        this.airLabel,
      ]),
      element('p', { class: 'note' }, [text.baked(content.texelM)]),
      element('div', { class: 'field row' }, [element('label', { for: 'language' }, [text.language]), this.makeLanguages()]),
    ]);
  }

  private makeLanguages(): HTMLSelectElement {
    const select = element('select', { id: 'language' }, languages.map((name) => element('option', { value: name, lang: name }, [texts[name].languageName])));
    select.value = language;
    select.addEventListener('change', () => {
      const address = new URL(location.href); // the part behind # restores the view
      address.searchParams.set('lang', select.value);
      location.assign(address);
    });
    return select;
  }

  show(isShown: boolean): void {
    const hadFocus = this.root.contains(document.activeElement) || document.activeElement === this.opener;
    this.root.hidden = !isShown;
    this.opener.hidden = isShown;
    if (hadFocus) (isShown ? this.instantSelect : this.opener).focus();
  }

  get isShown(): boolean {
    return !this.root.hidden;
  }

  update(state: PanelState): void {
    this.shownMoment = state.moment;
    this.between.textContent = state.label;
    this.between.hidden = Number.isInteger(state.moment);
    this.instantSelect.value = this.between.hidden ? String(state.moment) : '';
    this.instantSlider.value = String(state.moment);
    this.instantSlider.setAttribute('aria-valuetext', state.label);
    this.earlier.disabled = state.moment <= 0;
    this.later.disabled = state.moment >= Number(this.instantSlider.max);
    for (const [picture, button] of this.pictureButtons) button.setAttribute('aria-pressed', String(picture === state.picture));
    for (const [mode, button] of this.modeButtons) button.setAttribute('aria-pressed', String(mode === state.mode));
    for (const [part, button] of this.partButtons) {
      button.hidden = !state.parts.includes(part);
      button.setAttribute('aria-pressed', String(!state.off.includes(part)));
    }
    const isExposed = state.picture === 'lit' || state.picture === 'light';
    this.evSlider.value = String(state.ev);
    this.evSlider.disabled = !isExposed;
    this.evLabel.textContent = isExposed ? text.exposureValue(state.ev, state.exposure) : text.exposureUnused;
    this.evSlider.setAttribute('aria-valuetext', this.evLabel.textContent);
    this.airSwitch.checked = state.air && this.airNote !== null;
    this.airSwitch.disabled = state.picture !== 'lit' || this.airNote === null;
    this.airLabel.textContent = this.airSwitch.disabled ? text.airUnused : this.airNote;
  }

  /** Marks the view that is shown, or none when the user moved on by themselves. */
  showView(index: number | null): void {
    this.viewSelect.value = index === null ? '' : String(index);
  }

  /** What is known of the air; null where there is none to draw. Shown with the next update. */
  setAirNote(note: string | null): void {
    this.airNote = note;
  }

  showPlaying(isPlaying: boolean): void {
    this.playButton.textContent = isPlaying ? text.pause : text.play;
  }

  showSun(note: string): void {
    this.sunNote.textContent = note;
  }
}
