// Checks certificates with the checker that a page contains, under Pyodide in Node:
// node in_pyodide.cjs CHECKER.zip FILE... prints one JSON line for each file.
const { readFileSync } = require("node:fs");
const { loadPyodide } = require("pyodide");

const RUN = `
import contextlib, io, runpy, sys
sys.argv = ["checker", "/certificate"]
said = io.StringIO()
with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
    try:
        runpy.run_path("/checker.zip", run_name="__main__")
        code = 0
    except SystemExit as ended:
        code = ended.code
(code, said.getvalue().strip())
`;

async function main([archive, ...files]) {
  const python = await loadPyodide();
  python.FS.writeFile("/checker.zip", readFileSync(archive));
  for (const file of files) {
    python.FS.writeFile("/certificate", readFileSync(file));
    const [code, text] = python.runPython(RUN).toJs();
    console.log(JSON.stringify({ file, code, text }));
  }
}

main(process.argv.slice(2));
