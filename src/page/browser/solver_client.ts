// The page's side of the solver worker: one request of a kind at a time; the newest wins.
import type { Method } from "./methods";
import type { Frame, Load, Materials, Reply, Request } from "./protocol";
import workerProgram from "worker:worker.ts";

/** After this time a relight is returned unfinished, shown, and then continued. */
const RELIGHT_SLICE_MS = 60;
/** A relight that has not converged by then is left as it is, and reported. */
const RELIGHT_LIMIT_MS = 20_000;

type Loaded = Reply & { kind: "loaded" };
type Relit = Reply & { kind: "relit" };

export interface Relighting {
  irradiance: Float32Array; // of nodes, K * 3
  products: number; // with the matrix, since the change
  milliseconds: number; // since the change, solver alone
  residual: number; // over the mean irradiance
  converged: boolean;
  finished: boolean; // converged, or given up
}

export class SolverClient {
  onRelit: (light: Relighting) => void = () => {};
  onFrame: (frame: Frame) => void = () => {};
  onFailure: (message: string) => void = () => {};

  private readonly worker: Worker;
  private loaded: ((reply: Loaded) => void) | null = null;
  private readonly rowTickets = new Map<number, (rows: Float32Array[]) => void>();
  private readonly productTickets = new Map<number, (values: Float32Array) => void>();
  private tickets = 0;
  private wanted: Materials | null = null; // newer than those of the present relight
  private relighting = false;
  private products = 0;
  private milliseconds = 0;

  constructor() {
    const address = URL.createObjectURL(new Blob([workerProgram], { type: "text/javascript" }));
    this.worker = new Worker(address);
    URL.revokeObjectURL(address);
    this.worker.onmessage = (event: MessageEvent<Reply>) => this.take(event.data);
    this.worker.onerror = (event) => this.onFailure(event.message);
  }

  load(load: Load): Promise<Loaded> {
    return new Promise((resolve) => {
      this.loaded = resolve;
      this.send({ kind: "load", ...load });
    });
  }

  /** Rows of F, zeros included. */
  rows(nodes: number[]): Promise<Float32Array[]> {
    const ticket = ++this.tickets;
    return new Promise((resolve) => {
      this.rowTickets.set(ticket, resolve);
      this.send({ kind: "rows", ticket, nodes });
    });
  }

  /** F x, K * 3. */
  product(values: Float32Array): Promise<Float32Array> {
    const ticket = ++this.tickets;
    return new Promise((resolve) => {
      this.productTickets.set(ticket, resolve);
      this.send({ kind: "product", ticket, values });
    });
  }

  /** Does some unused work, so that the browser has compiled the solver when it is needed. */
  warm(): void { this.send({ kind: "warm" }); }

  relight(materials: Materials): void {
    this.wanted = materials;
    if (!this.relighting) this.nextRelight();
  }

  start(run: number, method: Method, materials: Materials): void {
    this.send({ kind: "start", run, method, materials });
  }

  step(run: number): void {
    this.send({ kind: "step", run });
  }

  private send(request: Request): void {
    this.worker.postMessage(request);
  }

  private nextRelight(): void {
    const materials = this.wanted;
    if (materials) {
      this.wanted = null;
      this.relighting = true;
      this.products = 0;
      this.milliseconds = 0;
    }
    if (this.relighting) {
      this.send({ kind: "relight", ticket: ++this.tickets, materials, milliseconds: RELIGHT_SLICE_MS });
    }
  }

  private takeRelit(reply: Relit): void {
    this.products += reply.products;
    this.milliseconds += reply.milliseconds;
    const { irradiance, residual, converged } = reply;
    const hopeless = !Number.isFinite(residual) || this.milliseconds > RELIGHT_LIMIT_MS;
    if ((converged || hopeless) && !this.wanted) this.relighting = false;
    const finished = !this.relighting;
    this.onRelit({ irradiance, residual, converged, finished, products: this.products,
                   milliseconds: this.milliseconds });
    if (!finished) this.nextRelight();
  }

  private take(reply: Reply): void {
    switch (reply.kind) {
      case "loaded":
        return this.loaded?.(reply);
      case "rows": {
        this.rowTickets.get(reply.ticket)?.(reply.rows);
        this.rowTickets.delete(reply.ticket);
        return;
      }
      case "product": {
        this.productTickets.get(reply.ticket)?.(reply.values);
        this.productTickets.delete(reply.ticket);
        return;
      }
      case "relit":
        return this.takeRelit(reply);
      case "frame":
        return this.onFrame(reply);
      case "failed":
        return this.onFailure(reply.message);
    }
  }
}
