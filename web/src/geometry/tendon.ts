/**
 * How much of each vertex is tendon, 0 to 1: the vertices of rigid links are (the links hold the central tendon), and
 * the weight fades into its neighbours over `rounds` edges so that colours run into each other as muscle does.
 */
export function tendonWeights(
  rigidLinks: Uint32Array,
  edges: Uint32Array,
  vertexCount: number,
  rounds = 4,
): Float32Array {
  let weights: Float32Array = new Float32Array(vertexCount);
  for (const vertex of rigidLinks) weights[vertex] = 1;
  for (let round = 0; round < rounds; round++) weights = neighbourMean(weights, edges);
  return weights;
}

function neighbourMean(weights: Float32Array, edges: Uint32Array): Float32Array {
  const sum = Float32Array.from(weights);
  const count = new Float32Array(weights.length).fill(1);
  for (let e = 0; e < edges.length; e += 2) {
    sum[edges[e]] += weights[edges[e + 1]];
    sum[edges[e + 1]] += weights[edges[e]];
    count[edges[e]]++;
    count[edges[e + 1]]++;
  }
  return sum.map((value, i) => value / count[i]);
}
