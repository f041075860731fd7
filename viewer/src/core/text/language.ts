// Which language the page speaks: what the address asks for (?lang=de), else what the browser prefers, else English.

export const languages = ['en', 'de'] as const;
export type Language = (typeof languages)[number];

/** @param wanted languages as the browser names them ("de-AT"), the best first */
export function chooseLanguage(asked: string | null, wanted: readonly string[]): Language {
  const known = (name: string): Language | undefined => languages.find((language) => language === name.slice(0, 2).toLowerCase());
  for (const name of asked === null ? wanted : [asked, ...wanted]) {
    const language = known(name);
    if (language) return language;
  }
  return 'en';
}

const isPage = typeof location !== 'undefined';
export const language: Language = chooseLanguage(
  isPage ? new URLSearchParams(location.search).get('lang') : null, isPage && typeof navigator !== 'undefined' ? navigator.languages : []);
