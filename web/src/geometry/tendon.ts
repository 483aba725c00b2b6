/**
 * Returns the tendon fraction of each vertex, 0 to 1: 1 at the vertices of rigid links, which model the central tendon,
 * smoothed over `rounds` rings of neighbours.
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
