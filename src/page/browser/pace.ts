// Chooses the resolution of software pictures while the viewer moves, so that they follow quickly.

/** `scale`: of width and height. `elements`: draws elements; false: patches, which are fewer. */
const LEVELS = [
  { scale: 1, elements: true },
  { scale: 0.5, elements: true },
  { scale: 0.5, elements: false },
  { scale: 0.3, elements: false },
] as const;
const SLOW_MS = 66, QUICK_MS = 12; // a level takes a quarter of the one before, about
const SLOW_PICTURES = 2, QUICK_PICTURES = 20; // one after the other, before it is another level

export class Pace {
  private level = 2;
  private finest = 0; // finer levels were too slow and are not tried again
  private slow = 0;
  private quick = 0;

  get scale(): number { return LEVELS[this.level]!.scale; }
  get elements(): boolean { return LEVELS[this.level]!.elements; }

  /** Records the time of a picture during a movement. */
  took(milliseconds: number): void {
    this.slow = milliseconds > SLOW_MS ? this.slow + 1 : 0;
    this.quick = milliseconds < QUICK_MS ? this.quick + 1 : 0;
    if (this.slow === SLOW_PICTURES && this.level + 1 < LEVELS.length) {
      this.finest = this.level + 1;
      this.turn(1);
    } else if (this.quick === QUICK_PICTURES && this.level > this.finest) {
      this.turn(-1);
    }
  }

  private turn(by: number): void {
    this.level += by;
    this.slow = this.quick = 0;
  }
}
