// The solvers that the page shows at work: their names, and what it says of each. What a frame of
// each computes is in session.ts.

interface MethodWords {
  name: string;
  unit: string; // of the run's slider: a frame
  units: string; // what the list of solvers says that one does
  firstFigure: number; // the frame that the first figure of the program's history is of
  figures: string; // what that history holds
  residualNote: string;
}

export const METHODS = {
  "jacobi": {
    name: "Jacobi", unit: "bounce", units: "bounces", firstFigure: 0, figures: "residuals", residualNote: "",
  },
  "gauss-seidel": {
    name: "Gauss-Seidel", unit: "sweep", units: "sweeps", firstFigure: 1,
    figures: "largest changes, the last one its residual", residualNote: "",
  },
  "southwell": {
    name: "Southwell", unit: "frame", units: "shots", firstFigure: 1, figures: "figures",
    residualNote: " (light not sent on yet)",
  },
} satisfies Record<string, MethodWords>;

export type Method = keyof typeof METHODS;

export const FIRST_METHOD: Method = "gauss-seidel";

export function wordsOf(method: Method): MethodWords { return METHODS[method]; }
