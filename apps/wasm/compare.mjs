// Compares two binary PLY files of the same model, from two platforms:
//
//     node apps/wasm/compare.mjs native.ply wasm.ply
//
// Sine, cosine and other functions of the platform's mathematics library may differ in the last bit. So the files
// must have the same header and the same triangles; their coordinates may differ by 1e-6 of the model's size, which
// is the precision of 32-bit numbers. Prints how many numbers differ; exits with 1 where anything else does.

import { readFileSync } from "node:fs";

const [first, second] = process.argv.slice(2).map((path) => readFileSync(path));
const END = "end_header\n";

function fail(reason) {
  console.error(reason);
  process.exit(1);
}

if (first === undefined || second === undefined) fail("usage: node compare.mjs FIRST.ply SECOND.ply");
const length = first.indexOf(END) + END.length;
const header = first.toString("latin1", 0, length);
if (header !== second.toString("latin1", 0, length)) fail("the headers differ");
if (first.length !== second.length) fail("the lengths differ");

const vertices = Number(/element vertex (\d+)/.exec(header)[1]);
const properties = /element vertex \d+\n((?:property .*\n)*)/.exec(header)[1].trim().split("\n");
const sizes = properties.map((line) => ({ float: 4, double: 8 })[line.split(" ")[1]]);
if (sizes.some((size) => size === undefined)) fail("a vertex property is no number");

let [offset, differing, largest, size] = [length, 0, 0, 0];
for (let vertex = 0; vertex < vertices; vertex++) {
  for (const bytes of sizes) {
    const read = (data) => (bytes === 4 ? data.readFloatLE(offset) : data.readDoubleLE(offset));
    const [a, b] = [read(first), read(second)];
    size = Math.max(size, Math.abs(a));
    if (a !== b) differing++;
    largest = Math.max(largest, Math.abs(a - b));
    offset += bytes;
  }
}
if (!first.subarray(offset).equals(second.subarray(offset))) fail("the triangles differ");
if (!(largest <= 1e-6 * size)) fail(`coordinates differ by up to ${largest}`);
console.log(
  differing === 0 ? "the same bytes" : `${differing} numbers differ, by rounding alone (at most ${largest})`,
);
