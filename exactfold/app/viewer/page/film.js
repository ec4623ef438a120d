// Pictures and animations of what is shown, as files.

import { download } from "./foldfile.js";
import { byId, say } from "./view.js";

const A_SECOND = 15, MOST_PICTURES = 90;

export function createFilm(view, server) {
  byId("png").disabled = byId("gif").disabled = !view.drawable();
  byId("mp4").hidden = !server;
  byId("png").addEventListener("click", async () => {
    const ground = getComputedStyle(byId("folded").closest(".pane")).backgroundColor;
    const picture = (view.store.get().folded && (await view.folded.picture(ground))) || view.picture();
    picture.toBlob((data) => save(data, ".png"));
  });
  byId("gif").addEventListener("click", () => film(".gif", gif));
  byId("mp4").addEventListener("click", () => film(".mp4", mp4));

  // The motion there and back, as fast as it is played.
  async function film(ending, encoded) {
    const { ways, way, speed } = view.store.get();
    if (!ways[way]?.motion) {
      say("There is no motion to save", true);
      return;
    }
    const seconds = 6.4 / speed;
    const count = Math.max(8, Math.min(MOST_PICTURES, 2 * Math.round((A_SECOND * seconds) / 2)));
    const button = byId(ending.slice(1));
    button.disabled = true;
    say(`Saving ${count} pictures …`);
    try {
      save(await encoded(count, seconds), ending);
    } catch (error) {
      say(error.message, true);
    }
    view.repaint();
    button.disabled = false;
  }

  // Picture `k` of so many; the page stays alive meanwhile.
  async function pictureAt(k, count) {
    if (k % 8 === 7) await new Promise(requestAnimationFrame);
    return view.picture(1 - Math.abs((2 * k) / count - 1));
  }

  async function gif(count, seconds) {
    const encoder = GIF.GIFEncoder(), delay = Math.max(20, Math.round((1000 * seconds) / count));
    const palette = GIF.quantize(someColours(), 256);
    for (let k = 0; k < count; k++) {
      const picture = await pictureAt(k, count);
      const pixels = GIF.applyPalette(pixelsOf(picture), palette);
      encoder.writeFrame(pixels, picture.width, picture.height, { palette: k ? undefined : palette, delay });
    }
    encoder.finish();
    return new Blob([encoder.bytes()], { type: "image/gif" });
  }

  // The colours of the flat sheet and of two stages of its motion: one palette for all pictures.
  function someColours() {
    const parts = [0, 0.5, 1].map((time) => pixelsOf(view.picture(time)));
    const all = new Uint8ClampedArray(parts.reduce((sum, part) => sum + part.length, 0));
    parts.reduce((start, part) => (all.set(part, start), start + part.length), 0);
    return all;
  }

  async function mp4(count, seconds) {
    const pictures = [];
    for (let k = 0; k < count; k++) pictures.push((await pictureAt(k, count)).toDataURL("image/png").split(",")[1]);
    const { data } = await server.one("film", { pictures, seconds });
    return new Blob([Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0))], { type: "video/mp4" });
  }

  function save(data, ending) {
    const name = view.name().replace(/\.fold$/, ending);
    download(data, name);
    say(`Saved ${name}`);
  }
}

function pixelsOf(canvas) {
  return canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
}
