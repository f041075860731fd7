import { english } from './text/en';
import { german } from './text/de';
import { language, type Language } from './text/language';

export type Text = typeof english;
export const texts: Record<Language, Text> = { en: english, de: german };

/** Every word that the user reads, in the page's language. */
export const text: Text = texts[language];
