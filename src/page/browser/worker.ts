// The solver in a thread of its own, so that the picture moves while it works.
import type { Reply, Request } from "./protocol";
import { Session } from "./session";
import kernel from "wat:product.wat";

/** The used part of a worker's global scope; the DOM's types only have windows. */
interface Scope {
  onmessage: ((event: MessageEvent<Request>) => void) | null;
  postMessage(reply: Reply): void;
}
const scope = self as unknown as Scope;
let session: Session | null = null;

function answer(request: Request): Reply | null {
  if (request.kind === "load") {
    session = new Session(request, kernel);
    return session.loaded;
  }
  if (!session) throw new Error("The solver was asked before it had the form factors");
  switch (request.kind) {
    case "rows":
      return { kind: "rows", ticket: request.ticket, rows: session.rows(request.nodes) };
    case "product":
      return { kind: "product", ticket: request.ticket, values: session.product(request.values) };
    case "warm":
      session.warm();
      return null;
    case "relight":
      return { ticket: request.ticket, ...session.relight(request.materials, request.milliseconds) };
    case "start":
      return { kind: "frame", ...session.start(request.run, request.method, request.materials) };
    case "step": {
      const frame = session.step(request.run);
      return frame && { kind: "frame", ...frame };
    }
  }
}

scope.onmessage = (event) => {
  try {
    const reply = answer(event.data);
    if (reply) scope.postMessage(reply);
  } catch (error) {
    scope.postMessage({ kind: "failed", message: error instanceof Error ? error.message : String(error) });
  }
};
