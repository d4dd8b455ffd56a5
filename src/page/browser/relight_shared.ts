// Relighting if patches share unknowns, as in `radiosity solve`. The first solution gives each
// unknown one radiosity. Then the variation within unknowns is found, and its effect between them
// is solved for.
import type { Rgb } from "./container";
import type { PatchMaterials } from "./protocol";
import { type Lit, Relight } from "./relight";
import { BANDS, source, type System } from "./solver";
import type { LightWithin } from "./within";

export class SharedRelight {
  finished = false;
  private solution: Relight;
  private means: Lit | null = null; // the first solution
  private productsBefore = 0;

  /** `sky`: its radiance; `seesOut`: an unknown sees the sky or backs. */
  constructor(private readonly system: System, lit: Lit, private readonly multiply: (x: Float64Array) => Float64Array,
              private readonly within: LightWithin, private readonly patches: PatchMaterials,
              private readonly sky: Rgb, private readonly seesOut: boolean) {
    this.solution = new Relight(system, lit, multiply);
  }

  get products(): number { return this.productsBefore + this.solution.products; }
  get residual(): number { return this.solution.residual; }
  irradiance(): Float64Array { return this.solution.irradiance(); }
  /** Irradiance of patches, N*3; null as long as light within unknowns is not known. */
  ofPatches(): Float64Array | null { return this.finished ? this.within.around(this.irradiance()) : null; }
  /** A start for other materials: the matrix' own solution. */
  lit(): Lit { return this.means ?? this.solution.lit(); }

  run(tolerance: number, expired: () => boolean): void {
    while (!this.finished) {
      this.solution.run(tolerance, expired);
      if (!(this.residual <= tolerance)) return;
      if (this.means) this.finished = true;
      else this.lookAround();
      if (expired()) return;
    }
  }

  /** Looks twice, since unknowns also see the light within others. */
  private lookAround(): void {
    const { within, system } = this;
    const means = this.solution.lit();
    const ofMeans = means.irradiance.map((h, k) => system.emission[k]! + system.reflectance[k]! * h);
    within.look(within.spread(ofMeans), this.sky);
    const radiosity = this.radiosityOf(within.around(means.irradiance));
    within.look(radiosity, this.sky);
    const beyond = this.balanced(within.beyondMeans(radiosity), means.irradiance);
    const more = system.more.map((h, k) => h + beyond[k]!);
    const again = { ...system, more };
    this.productsBefore = this.products;
    this.solution = new Relight(again, { irradiance: means.irradiance, source: source(again) }, this.multiply);
    this.means = means;
  }

  private radiosityOf(irradiance: Float64Array): Float64Array {
    const { emission, reflectance } = this.patches;
    return irradiance.map((h, k) => emission[k]! + reflectance[k]! * h);
  }

  /** `beyond` limited so that irradiance is not negative; in closed scenes it adds no power. */
  private balanced(beyond: Float64Array, irradiance: Float64Array): Float64Array {
    const out = beyond.map((more, k) => Math.max(more, -irradiance[k]!));
    if (this.seesOut) return out;
    const made = this.powers(out), had = this.powers(irradiance);
    return out.map((more, k) => {
      const b = k % BANDS;
      const all = made[b]! + had[b]!;
      return all > 0 ? more - (made[b]! / all) * (irradiance[k]! + more) : more;
    });
  }

  private powers(values: Float64Array): Float64Array {
    const sums = new Float64Array(BANDS);
    values.forEach((value, k) => {
      sums[k % BANDS] = sums[k % BANDS]! + this.system.factors.area[Math.floor(k / BANDS)]! * value;
    });
    return sums;
  }
}
