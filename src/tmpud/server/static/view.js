// Asks each second for the part of the page that changes while something is being run.
const live = document.querySelector("#live");
const lost = document.querySelector("#lost");
const frame = document.querySelector("#frame");
const newer = document.querySelector("#newer");

async function refresh() {
  try {
    const answer = await fetch(`${live.dataset.part}?seen=${live.dataset.seen}`);
    if (answer.status === 200) {
      const before = live.querySelector("details");
      live.innerHTML = await answer.text(); // every name in it is escaped by the server
      live.dataset.seen = answer.headers.get("X-Seen");
      if (before !== null) live.querySelector("details")?.toggleAttribute("open", before.open);
      compare();
    }
    lost.hidden = answer.ok;
  } catch {
    lost.hidden = false;
  }
  setTimeout(refresh, 1000);
}

/** Offers what came since the replay or the report was loaded. */
function compare() {
  const now = live.querySelector("[data-version]");
  if (now === null) return;
  if (frame === null && now.dataset.shown === "yes") location.reload();
  if (frame !== null) newer.hidden = now.dataset.version === frame.dataset.version;
}

newer?.addEventListener("click", () => {
  frame.dataset.version = live.querySelector("[data-version]").dataset.version;
  frame.src = frame.getAttribute("src");
  newer.hidden = true;
});

setTimeout(refresh, 1000);
