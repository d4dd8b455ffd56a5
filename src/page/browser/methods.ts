// The solvers that can be watched: their names and texts. session.ts computes their frames.

interface MethodWords {
  name: string;
  unit: string; // of the run's slider: a frame
  units: string; // the description in the list of solvers
  firstFigure: number; // the frame of the first figure in the program's history
  figures: string; // the meaning of that history
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
