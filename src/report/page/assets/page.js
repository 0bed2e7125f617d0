// What begins when the page is there.

/** Puts text on the clipboard, in the old way where a page from the disk may not do it in the new one. */
async function copy(text, button) {
  let done = false;
  try {
    await navigator.clipboard.writeText(text);
    done = true;
  } catch {
    const area = document.createElement("textarea");
    area.value = text;
    document.body.append(area);
    area.select();
    done = document.execCommand("copy");
    area.remove();
  }
  button.textContent = done ? "Copied" : "Copy by hand";
  setTimeout(() => { button.textContent = "Copy"; }, 1500);
}

document.querySelectorAll("table.sortable").forEach(makeSortable);

const viewers = new Map();

async function start() {
  for (const root of document.querySelectorAll(".viewer")) {
    try {
      viewers.set(root.dataset.viewer, await Viewer.of(root));
    } catch (error) {
      const note = document.createElement("p");
      note.className = "absent";
      note.textContent = `The maps cannot be shown: ${error.message}. They need a browser of 2023 or later.`;
      root.append(note);
    }
  }
  document.documentElement.dataset.ready = "true";
}

document.addEventListener("click", async (event) => {
  const button = event.target.closest("button.goto");
  const viewer = button && viewers.get(button.dataset.viewer);
  if (!viewer) return;
  await viewer.chooseLight(Number(button.dataset.light));
  viewer.goTo(Number(button.dataset.x), Number(button.dataset.y));
  viewer.root.scrollIntoView({ block: "start" });
  viewer.panels.verdict.canvas.focus({ preventScroll: true });
});

// On paper everything is open.
window.addEventListener("beforeprint", () => {
  for (const details of document.querySelectorAll("details")) details.open = true;
});

start();
