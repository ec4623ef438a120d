// The checker in the page: Pyodide runs it, and it verifies the certificate that the page contains.

const RUN = [
  "import contextlib, io, runpy, sys",
  "sys.argv = ['checker', '/certificate']",
  "said = io.StringIO()",
  "with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):",
  "    try:",
  "        runpy.run_path('/checker.zip', run_name='__main__')",
  "        code = 0",
  "    except SystemExit as ended:",
  "        code = ended.code",
  "(code, said.getvalue().strip())",
].join("\n");

// A button that checks, and the verdict beside it.
export function createChecking({ certificate, source, pyodide }) {
  const button = document.getElementById("check"), said = document.getElementById("checked");
  document.getElementById("checking").hidden = false;
  button.addEventListener("click", async () => {
    const tell = (text, kind) => Object.assign(said, { textContent: text, className: kind });
    button.disabled = true;
    tell("Python is loaded …", "");
    try {
      const address = new URL(pyodide, location.href);
      if (address.protocol === "file:") {
        throw new Error("a browser loads Python only from a server. Run `python -m http.server` in the folder of this page, and open the page from there");
      }
      const { loadPyodide } = await import(new URL("pyodide.mjs", address).href);
      const python = await loadPyodide({ indexURL: address.href });
      python.FS.writeFile("/checker.zip", Uint8Array.from(atob(source), (c) => c.charCodeAt(0)));
      python.FS.writeFile("/certificate", certificate);
      tell("The certificate is checked …", "");
      await new Promise((painted) => setTimeout(painted, 50));
      const [code, verdict] = python.runPython(RUN).toJs();
      tell(verdict, code === 0 ? "good" : "wrong");
    } catch (error) {
      tell(`Not checked: ${error.message}`, "wrong");
    }
    button.disabled = false;
  });
}
