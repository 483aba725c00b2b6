import { expect, test } from "vitest";
import { neighbourPredictor } from "../../../web/src/decoders/neighbour_predictor";
import { neighbourWeights, weightUnit } from "../../../web/src/decoders/neighbour_weights";
import type { RestShape } from "../../../web/src/decoders/rest_shape";

let seed = 1;
const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647;

/** An irregular grid with this number of vertices per side. */
function grid(side: number): RestShape {
  const rest = Float32Array.from({ length: 3 * side * side }, (_, i) => {
    const [column, row] = [Math.floor(i / 3) % side, Math.floor(i / 3 / side)];
    return [column, row, 0][i % 3] + 0.4 * random();
  });
  const neighbours = Array.from({ length: side * side }, (_, i) => {
    const all = [i - side, i % side > 0 ? i - 1 : -1, (i + 1) % side > 0 ? i + 1 : -1, i + side];
    return all.filter((other) => other >= 0 && other < side * side);
  });
  return { rest, neighbours, basisShapes: [] };
}

/** The definition in proto/README.md, in integers of arbitrary size. */
function asDefined(shape: RestShape, residuals: Int32Array): Int32Array {
  const { first, neighbours, weights } = neighbourWeights(shape);
  const values = residuals.slice();
  for (let place = 0; place + 1 < first.length; place++) {
    for (let axis = 0; axis < 3; axis++) {
      let sum = BigInt(weightUnit / 2);
      for (let i = first[place]; i < first[place + 1]; i++)
        sum += BigInt(weights[i]) * BigInt(values[3 * neighbours[i] + axis]);
      const predicted = sum >> BigInt(Math.log2(weightUnit));
      values[3 * place + axis] = Number(BigInt.asIntN(32, BigInt(values[3 * place + axis]) + predicted));
    }
  }
  return values;
}

test.each([3, 3000, 2 ** 20, 2 ** 31 - 1])("ValuesUpTo %i ArePredictedAsDefined", (largest) => {
  const shape = grid(12);
  const remainders = Int32Array.from({ length: shape.rest.length }, () => Math.round((2 * random() - 1) * largest));
  const values = remainders.slice();
  neighbourPredictor(shape).addPredictions(values);
  expect(values).toEqual(asDefined(shape, remainders));
});

test("OneLargeResidualAmongSmallOnesIsPredictedAsDefined", () => {
  const shape = grid(9);
  const residuals = Int32Array.from({ length: shape.rest.length }, () => Math.round(4 * random()) - 2);
  residuals[3 * 40 + 1] = 2 ** 30;
  const values = residuals.slice();
  neighbourPredictor(shape).addPredictions(values);
  expect(values).toEqual(asDefined(shape, residuals));
});
