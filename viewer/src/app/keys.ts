import { pictures } from '../core/pictures';
import type { App } from './app';

/** The page's keys; those that walk are WalkMode's own. */
export function listenForKeys(app: App): void {
  window.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target instanceof Element && event.target.closest('select, textarea, input:not([type=range], [type=checkbox]), dialog')) return;
    const action = actionOf(app, event);
    if (!action) return;
    action();
    event.preventDefault();
  });
}

function actionOf(app: App, { key, code }: KeyboardEvent): (() => void) | null {
  const { viewer } = app;
  const picture = pictures[Number(key) - 1];
  if (picture) return picture !== 'layer' || app.hasLayers ? () => app.setPicture(picture) : null;
  if (key === '?') return () => app.showHelp();
  if (key === ',') return () => void app.showMoment(Math.ceil(viewer.moment) - 1);
  if (key === '.') return () => void app.showMoment(Math.floor(viewer.moment) + 1);
  if (key === 'Escape') return app.measuring.isOpen ? () => app.measuring.close() : null;
  if (key === '+' || key === '=') return () => app.setEv(viewer.ev + 0.5);
  if (key === '-') return () => app.setEv(viewer.ev - 0.5);
  switch (code) {
    case 'KeyB': return app.comparing && (() => app.comparing?.changeSides());
    case 'KeyC': return app.comparing && (() => app.comparing?.swipeOrDifference());
    case 'KeyM': return () => app.measureMiddle();
    case 'KeyF': return () => app.setAir(!viewer.air);
    case 'KeyL': return () => app.lookByMouse();
    case 'KeyN': return () => app.showMap(!app.isMapShown);
    case 'KeyO': return () => app.setMode('orbit');
    case 'KeyP': return () => app.setMode('walk');
    case 'KeyR': return () => app.showView(0);
    case 'KeyH': return () => app.togglePanel();
    default: return null;
  }
}
