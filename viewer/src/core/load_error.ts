/** A file of the bake that is missing or unusable: the page shows the message together with the file's address. */
export class LoadError extends Error {
  constructor(
    readonly url: string,
    message: string,
  ) {
    super(message);
    this.name = 'LoadError';
  }
}
