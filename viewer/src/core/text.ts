// Every word that the user reads, in one place: a translation replaces this file.

export const text = {
  pageTitle: (title: string) => `${title} – skybake`,
  untitled: 'City',
  panelLabel: 'Settings of the walkthrough',
  canvasLabel: 'The city in its baked daylight. Drag to look, arrow keys to move; the line below lists all keys.',
  instant: 'Time',
  instantSlider: 'Time, as a slider',
  previousInstant: 'Earlier',
  nextInstant: 'Later',
  picture: 'Picture',
  pictures: { lit: 'Lit', textures: 'Textures', light: 'Light' },
  pictureHints: {
    lit: 'Textures in sun and skylight',
    textures: 'Textures alone, without light',
    light: 'Light alone, on white walls',
  },
  parts: 'Light of',
  partNames: { sun: 'Sun', sky: 'Sky', indirect: 'Reflections', lamps: 'Lamps' },
  partHints: {
    sun: 'Direct sunlight',
    sky: 'Skylight',
    indirect: 'Light that walls and ground reflect',
    lamps: 'Direct light of lamps',
  },
  navigation: 'Move',
  modes: { orbit: 'Orbit', walk: 'Walk' },
  modeHints: { orbit: 'Fly about the city', walk: 'Walk on the ground, eye at 1.7 m' },
  views: 'View',
  birdsEye: 'Bird’s eye',
  onFoot: 'On foot',
  freeView: 'Own view',
  exposure: 'Exposure',
  exposureReset: 'Auto',
  exposureValue: (ev: number, total: number) =>
    `${ev > 0 ? '+' : ev < 0 ? '−' : '±'}${Math.abs(ev).toFixed(1)} EV · white at ${formatLuminance(1 / total)}`,
  exposureUnused: 'not used: no light in this picture',
  copyLink: 'Copy link',
  copyLinkHint: 'Copies the address of this very view, for others and for “skybake render --camera”',
  linkCopied: 'The link to this view is copied.',
  linkNotCopied: 'This browser lets no page copy here: take the link from the address bar.',
  air: 'Air',
  airSwitch: 'Haze over distance',
  airHint: 'What the air between you and the city takes and adds; off: as in a vacuum',
  airNote: (turbidity: number, sightKm: number) => `turbidity ${turbidity.toFixed(1)}: sight ${sightKm.toFixed(0)} km`,
  airUnused: 'not used in this picture',
  hidePanel: 'Hide',
  showPanel: 'Settings',
  help: {
    orbit: 'Drag: turn · Right drag or Shift+drag: shift · Wheel: nearer · P: walk · 1 2 3: picture · , .: time · + −: exposure · F: haze · R: reset · H: hide panel',
    walk: 'W A S D or arrows: walk · Shift: run · Drag: look · O: orbit · 1 2 3: picture · , .: time · + −: exposure · F: haze · R: reset · H: hide panel',
  },
  movePad: 'Walk',
  movePadButtons: { forward: 'Forward', back: 'Back', left: 'Left', right: 'Right' },
  sun: (azimuth: number, elevation: number, klx: number) =>
    elevation <= 0
      ? `Sun below the horizon (${elevation.toFixed(1)}°)`
      : `Sun: azimuth ${azimuth.toFixed(1)}°, elevation ${elevation.toFixed(1)}°, beam ${klx.toFixed(klx < 10 ? 1 : 0)} klx`,
  noSun: 'No sun: skylight alone',
  baked: (texelM: number) => `All light and shadow is baked at ${formatLength(texelM)}; nothing is computed live.`,
  loading: (what: string) => `Loading ${what}`,
  loadingParts: { manifest: 'the bake’s description', city: 'the city', light: (label: string) => `the light of ${label}` },
  bytes: (loaded: number, total: number | null) =>
    total === null ? formatBytes(loaded) : `${formatBytes(loaded)} of ${formatBytes(total)}`,
  preparingWalk: 'Preparing the ground to walk on',
  nowShowing: (label: string) => `Now showing ${label}`,
  noGround: 'No open ground was found to walk on; still in orbit.',
  error: {
    heading: 'This bake cannot be shown',
    file: 'File',
    reload: 'Try again',
    missing: (status: number) => `The server has no such file (HTTP ${status}). Was the bake folder copied whole?`,
    unreachable: 'The file cannot be reached. Is the server still running? A page opened from disk (file://) cannot load a bake: use “skybake view”.',
    truncated: (got: number, expected: number) => `The file has ${got} bytes; the bake’s description says ${expected}. Copy the bake again.`,
    notJson: 'The file is not JSON.',
    schema: (problems: string) => `The file does not follow the schema of a bake: ${problems}.`,
    otherVersion: (version: unknown) => `The bake has version ${String(version)}; this walkthrough reads version 1. Use the walkthrough that came with the bake.`,
    size: (got: number, expected: number) => `The file holds ${got} bytes where ${expected} are needed.`,
    pageSize: (got: string, expected: string) => `The picture is ${got} texels; the bake’s description says ${expected}.`,
    notAPicture: 'The file is not a picture that this browser can decode.',
    notAModel: (why: string) => `The file is not a glTF model that can be shown: ${why}`,
    emptyModel: 'The model holds no surfaces.',
    noLightmap: (material: string) => `The material “${material}” names no lightmap page (SKYBAKE_lightmap).`,
    noLampPage: 'The bake’s description names lamps, but a page without their light.',
    noInstants: 'The bake holds no instant, so there is no light to show.',
    tooManyCharts: (got: number, expected: number) => `The model speaks of ${got} charts; the bake’s description has ${expected}. They belong to different bakes.`,
    noCoordinates: (mesh: string) => `The mesh “${mesh}” lacks TEXCOORD_1 or _CHART, without which it cannot be lit.`,
    noWebGl: 'This browser offers no WebGL 2, which the walkthrough draws with.',
    contextLost: 'The graphics driver stopped the drawing (lost context). Reload the page.',
    unexpected: (why: string) => `Something unexpected happened: ${why}`,
  },
} as const;

function formatBytes(bytes: number): string {
  return bytes < 1e6 ? `${(bytes / 1e3).toFixed(0)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
}

function formatLength(metres: number): string {
  return metres >= 1 ? `${metres} m` : `${Math.round(metres * 1000) / 10} cm`;
}

function formatLuminance(kcdPerM2: number): string {
  if (kcdPerM2 >= 1) return `${kcdPerM2.toFixed(1)} kcd/m²`;
  const cd = kcdPerM2 * 1000;
  return `${cd >= 10 ? cd.toFixed(0) : cd.toPrecision(2)} cd/m²`;
}
