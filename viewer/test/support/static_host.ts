// A plain web host on the loopback interface: the viewer's built files laid over a bake folder, as a shipped bake has them.
import fs from 'node:fs';
import http from 'node:http';
import type { AddressInfo } from 'node:net';
import path from 'node:path';

const types: Record<string, string> = { '.html': 'text/html; charset=utf-8', '.js': 'text/javascript', '.css': 'text/css', '.json': 'application/json', '.png': 'image/png', '.glb': 'model/gltf-binary' };

export interface Host {
  url: string;
  close(): Promise<void>;
}

/**
 * @param answer may replace a file's bytes, or refuse it with null: for tests of what goes wrong
 * @param knowsRanges false for a host that always sends whole files
 */
export function serve(roots: readonly string[], answer: (name: string, bytes: Buffer | null) => Buffer | null = (_, bytes) => bytes, knowsRanges = true): Promise<Host> {
  const server = http.createServer((request, response) => {
    const name = decodeURIComponent(new URL(request.url ?? '/', 'http://host').pathname).replace(/^\/$/, '/index.html').slice(1);
    const found = roots.map((root) => path.join(root, name)).find((file) => fs.existsSync(file));
    const bytes = answer(name, found && !name.includes('..') ? fs.readFileSync(found) : null);
    if (!bytes) return void response.writeHead(404).end('not found');
    const range = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? '');
    if (range && knowsRanges) {
      const [first, last] = [Number(range[1]), Math.min(Number(range[2]), bytes.length - 1)];
      response.writeHead(206, { 'content-range': `bytes ${first}-${last}/${bytes.length}`, 'cache-control': 'no-store' });
      return void response.end(bytes.subarray(first, last + 1));
    }
    response.writeHead(200, { 'content-type': types[path.extname(name)] ?? 'application/octet-stream', 'cache-control': 'no-store' }).end(bytes);
  });
  return new Promise((resolve) => {
    server.listen(0, '127.0.0.1', () => resolve({
      url: `http://127.0.0.1:${(server.address() as AddressInfo).port}/`,
      close: () => new Promise((done) => server.close(() => done())),
    }));
  });
}
