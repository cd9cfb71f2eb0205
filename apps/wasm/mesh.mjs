// Meshes a CAD file with the WebAssembly module, in node:
//
//     node apps/wasm/mesh.mjs chordal_wasm.wasm part.step 0.1 out.ply
//
// The tolerance is in millimetres; the output is PLY, or GLB by its extension.

import { readFileSync, writeFileSync } from "node:fs";

const [modulePath, inputPath, tolerance, outputPath] = process.argv.slice(2);
if (outputPath === undefined) {
  console.error("usage: node mesh.mjs chordal_wasm.wasm INPUT TOLERANCE_MM OUTPUT");
  process.exit(2);
}

// The module imports nothing: all that it needs comes with it.
const module = await WebAssembly.compile(readFileSync(modulePath));
const chordal = (await WebAssembly.instantiate(module, {})).exports;

const input = readFileSync(inputPath);
const address = chordal.chordal_allocate(input.length);
// The memory may move when it grows: its view is made anew whenever it is needed.
new Uint8Array(chordal.memory.buffer, address, input.length).set(input);

const format = outputPath.endsWith(".glb") ? 1 : 0;
let code;
try {
  code = chordal.chordal_mesh(Number(tolerance), format);
} catch (error) {
  // A mesh that needs more than the 4 GiB of WebAssembly ends here.
  console.error(`chordal: the module stopped: ${error.message}`);
  process.exit(3);
}
const result = new Uint8Array(
  chordal.memory.buffer,
  chordal.chordal_result(),
  chordal.chordal_result_length(),
);
if (code === 2) {
  console.error(`chordal: ${new TextDecoder().decode(result)}`);
} else {
  writeFileSync(outputPath, result);
}
process.exit(code);
