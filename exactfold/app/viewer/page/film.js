// Pictures and animations of what is shown, as files.

import { byId, say } from "./view.js";

const A_SECOND = 15, MOST_PICTURES = 90;

export function createFilm(view, server) {
  byId("png").disabled = !view.drawable();
  byId("png").addEventListener("click", () => save(view.picture().toDataURL("image/png"), ".png"));
  for (const ending of [".gif", ".mp4"]) {
    const button = byId(ending.slice(1));
    button.hidden = !server;
    button.addEventListener("click", () => film(ending, button));
  }

  // The motion there and back, as fast as it is played.
  async function film(ending, button) {
    const { ways, way, speed } = view.store.get();
    if (!ways[way]?.motion) {
      say("There is no motion to save", true);
      return;
    }
    const seconds = 6.4 / speed;
    const count = Math.max(8, Math.min(MOST_PICTURES, 2 * Math.round((A_SECOND * seconds) / 2)));
    button.disabled = true;
    say(`Saving ${count} pictures …`);
    try {
      const pictures = [];
      for (let k = 0; k < count; k++) {
        const time = 1 - Math.abs((2 * k) / count - 1);
        pictures.push(view.picture(time).toDataURL("image/png").split(",")[1]);
        if (k % 8 === 7) await new Promise(requestAnimationFrame);
      }
      view.repaint();
      const { data } = await server.one("film", { ending, pictures, seconds });
      save(`data:${ending === ".gif" ? "image/gif" : "video/mp4"};base64,${data}`, ending);
    } catch (error) {
      say(error.message, true);
    }
    button.disabled = false;
  }

  function save(address, ending) {
    const name = view.name().replace(/\.fold$/, ending);
    Object.assign(document.createElement("a"), { href: address, download: name }).click();
    say(`Saved ${name}`);
  }
}
