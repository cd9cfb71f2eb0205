// Meshes CAD files with the WebAssembly module, in node:
//
//     node apps/wasm/mesh.mjs chordal_wasm.wasm part.step 0.1 out.ply
//
// The tolerance is in millimetres; the output is PLY, or GLB by its extension. With `-` in place of the input,
// standard input is a list of files, one per line: the input, a tab, the output. Standard output gets the exit
// code of each, one per line.

import { readFileSync, writeFileSync } from "node:fs";

/**
 * Meshes one file. Returns the exit code of the program (0: no problem, 1: a mesh with problems, 2: no mesh),
 * or 3 if the module stopped, and the bytes of the mesh or a sentence.
 */
function mesh(module, input, tolerance, format) {
  // The module imports nothing. Every file gets an instance of its own: memory never shrinks.
  const chordal = new WebAssembly.Instance(module, {}).exports;
  const address = chordal.chordal_allocate(input.length);
  // A view of the memory is invalid after the memory has grown, so each access makes a new one.
  new Uint8Array(chordal.memory.buffer, address, input.length).set(input);
  let code;
  try {
    code = chordal.chordal_mesh(tolerance, format);
  } catch (error) {
    // For instance, the mesh needs more than the 4 GiB of WebAssembly.
    return { code: 3, sentence: `the module stopped: ${error.message}` };
  }
  const result = new Uint8Array(
    chordal.memory.buffer,
    chordal.chordal_result(),
    chordal.chordal_result_length(),
  );
  return code === 2
    ? { code, sentence: new TextDecoder().decode(result) }
    : { code, bytes: result };
}

/** Meshes one file into another; messages go to standard error. Returns the exit code. */
function meshFile(module, inputPath, tolerance, outputPath) {
  const format = outputPath.endsWith(".glb") ? 1 : 0;
  const made = mesh(module, readFileSync(inputPath), tolerance, format);
  if (made.bytes === undefined) {
    console.error(`chordal: ${inputPath}: ${made.sentence}`);
  } else {
    writeFileSync(outputPath, made.bytes);
  }
  return made.code;
}

const [modulePath, inputPath, tolerance, outputPath] = process.argv.slice(2);
if (tolerance === undefined || (inputPath !== "-" && outputPath === undefined)) {
  console.error("usage: node mesh.mjs chordal_wasm.wasm INPUT TOLERANCE_MM OUTPUT");
  process.exit(2);
}
const module = await WebAssembly.compile(readFileSync(modulePath));
if (inputPath === "-") {
  for (const line of readFileSync(0, "utf8").split("\n").filter((line) => line !== "")) {
    const [input, output] = line.split("\t");
    console.log(meshFile(module, input, Number(tolerance), output));
  }
} else {
  process.exit(meshFile(module, inputPath, Number(tolerance), outputPath));
}
