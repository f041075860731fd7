import './ui/style.css';
import { App } from './app/app';
import { language } from './core/text/language';
import { installTestHook } from './app/test_hook';
import { showError } from './ui/notices';

// `?antialias=off` halves the work of a software rasteriser.
const isAntialiased = new URLSearchParams(location.search).get('antialias') !== 'off';

document.documentElement.lang = language;

try {
  const app = new App(new URL('manifest.json', document.baseURI).href, isAntialiased);
  const ready = app.start();
  installTestHook(app, ready);
  ready.catch(showError);
} catch (error) {
  showError(error);
}
