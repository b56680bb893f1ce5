/** Reproducible numbers (mulberry32) for the made-up data of the tests. */
export class Random {
  constructor(private state: number) {}
  uniform(low = 0, high = 1): number {
    this.state = (this.state + 0x6d2b79f5) | 0;
    let t = Math.imul(this.state ^ (this.state >>> 15), 1 | this.state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return low + (high - low) * (((t ^ (t >>> 14)) >>> 0) / 4294967296);
  }
  normal(mean = 0, sd = 1): number {
    const u = Math.max(1e-12, this.uniform());
    return mean + sd * Math.sqrt(-2 * Math.log(u)) * Math.cos(2 * Math.PI * this.uniform());
  }
  pick<T>(values: readonly T[]): T {
    return values[Math.floor(this.uniform() * values.length)];
  }
}
