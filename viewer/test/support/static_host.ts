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

/** @param answer may replace a file's bytes, or refuse it with null: for tests of what goes wrong */
export function serve(roots: readonly string[], answer: (name: string, bytes: Buffer | null) => Buffer | null = (_, bytes) => bytes): Promise<Host> {
  const server = http.createServer((request, response) => {
    const name = decodeURIComponent(new URL(request.url ?? '/', 'http://host').pathname).replace(/^\/$/, '/index.html').slice(1);
    const found = roots.map((root) => path.join(root, name)).find((file) => fs.existsSync(file));
    const bytes = answer(name, found && !name.includes('..') ? fs.readFileSync(found) : null);
    if (!bytes) return void response.writeHead(404).end('not found');
    response.writeHead(200, { 'content-type': types[path.extname(name)] ?? 'application/octet-stream', 'cache-control': 'no-store' }).end(bytes);
  });
  return new Promise((resolve) => {
    server.listen(0, '127.0.0.1', () => resolve({
      url: `http://127.0.0.1:${(server.address() as AddressInfo).port}/`,
      close: () => new Promise((done) => server.close(() => done())),
    }));
  });
}
