// The texts of the tour, a step each, in the order of the method. "{patches}" stands for their number.
export interface TourText {
  title: string;
  text: string;
  equation: string;
}

export const TOUR = {
  patch: {
    title: "Patches",
    text: "All surfaces of this scene are cut into {patches} patches. Each has one radiosity B: the light E that it emits, " +
      "and the share ρ that it reflects of the light H that falls on it, evenly to all sides.",
    equation: "B = E + ρ H",
  },
  factor: {
    title: "Form factors",
    text: "How much of all that the outlined patch sees is each other patch? That share is a form factor. It falls with " +
      "the square of the distance r and with both slants, and is 0 where something stands in between (V = 0). " +
      "All of one patch's are a row of the matrix: its colours.",
    equation: "Fᵢⱼ = 1/Aᵢ ∫∫ V cos θᵢ cos θⱼ / (π r²) dAⱼ dAᵢ",
  },
  hemicube: {
    title: "Hemicube",
    text: "One way to find a row: stand on the patch and draw what is there to see on half a cube. Each pixel at (x, y) counts " +
      "by its own small form factor. This is what the patch sees straight ahead, in the colours of its row.",
    equation: "ΔF = ΔA / (π (x² + y² + 1)²)",
  },
  first: {
    title: "First bounce",
    text: "Light leaves the lamps and falls on what they see. All else is dark: shadows are black, and so is a ceiling " +
      "above its lamps.",
    equation: "B¹ = E + ρ F E",
  },
  more: {
    title: "Second and third bounce",
    text: "Each patch passes on what it got. Shadows fill, and colours bleed from wall to wall. Every bounce brings less " +
      "than the one before, since patches keep a part.",
    equation: "Bᵏ = E + ρ F Bᵏ⁻¹",
  },
  solution: {
    title: "The solution",
    text: "After all bounces nothing changes any more: the light solves one system of linear equations. Solvers find it " +
      "without counting bounces. Where a patch is too coarse for a shadow, finer elements show it.",
    equation: "(I − ρ F) B = E",
  },
  error: {
    title: "Error",
    text: "What three bounces lack is painted blue. The program goes on until the residual is as small as was asked for, and " +
      "says how far the light can be off. Errors of form factors it says row by row.",
    equation: "r = E + ρ F B − B",
  },
} satisfies Record<string, TourText>;
