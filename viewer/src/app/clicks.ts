/** A pointer that moved less than this between down and up has clicked, CSS pixels. */
const slack = 4;

/** Tells of clicks that are no drags. */
export function listenForClicks(canvas: HTMLCanvasElement, onClick: (at: { x: number; y: number }) => void): void {
  let down: PointerEvent | null = null;
  canvas.addEventListener('pointerdown', (event) => (down = event.isPrimary && event.button === 0 ? event : null));
  canvas.addEventListener('pointerup', (event) => {
    const isClick = down !== null && down.pointerId === event.pointerId && Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) <= slack;
    down = null;
    if (isClick) onClick({ x: event.offsetX, y: event.offsetY });
  });
}
