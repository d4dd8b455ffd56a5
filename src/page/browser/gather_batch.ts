// Chooses how many eyes look in a frame, so that they take about the time it has for them.

export class Batch {
  size = 1;

  /** `budget`: milliseconds of a batch. `most`: eyes a batch. */
  constructor(private readonly budget: number, private readonly most: number) {}

  /** Records the time of a batch of `looks` eyes, which are fewer than `size` at the end of a pass or row. */
  took(looks: number, milliseconds: number): void {
    if (looks < this.size && milliseconds <= this.budget) return; // cut short, it says little of a whole one
    const wanted = Math.round((looks * this.budget) / Math.max(milliseconds, 1));
    this.size = Math.max(1, Math.min(wanted, 2 * this.size, this.most));
  }
}
