/** Waits until the graphics card has drawn everything. */
export function finishDrawing(gl: WebGLRenderingContext | WebGL2RenderingContext): void {
  gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
}

/** A block of the picture drawn last, RGBA 0…255, rows from the top; (x, y) from the canvas's upper left corner, device pixels. */
export function readBlock(gl: WebGLRenderingContext | WebGL2RenderingContext, x: number, y: number, width: number, height: number): Uint8Array {
  const pixels = new Uint8Array(width * height * 4);
  gl.readPixels(x, gl.drawingBufferHeight - y - height, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  const topDown = new Uint8Array(pixels.length); // WebGL counts rows from below
  for (let row = 0; row < height; ++row) topDown.set(pixels.subarray(row * width * 4, (row + 1) * width * 4), (height - 1 - row) * width * 4);
  return topDown;
}

export function pngOf(canvas: HTMLCanvasElement): Promise<Blob> {
  return new Promise((resolve, reject) => canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('no PNG'))), 'image/png'));
}
