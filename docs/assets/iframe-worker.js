/* Search in pages that are opened as files. Browsers start no worker from a file, so this one is a frame
 * that loads the worker's script and exchanges messages with the page. The theme would load such a shim
 * from a host; it takes ours because of the file's name (mkdocs.yml, extra.polyfills). */
if (window.location.protocol === "file:") {
  window.Worker = class extends EventTarget {
    constructor(url) {
      super();
      const frame = document.createElement("iframe");
      frame.hidden = true;
      document.body.appendChild(frame);
      const inside = frame.contentWindow;
      this.loaded = new Promise((done) => {
        inside.postMessage = (data) => this.dispatchEvent(new MessageEvent("message", { data }));
        inside.importScripts = (...urls) => Promise.all(urls.map((one) => this.load(inside, one)));
        this.load(inside, url).then(done);
      });
      this.inside = inside;
    }

    load(inside, url) {
      return new Promise((done, failed) => {
        const script = inside.document.createElement("script");
        script.src = url;
        script.onload = done;
        script.onerror = failed;
        inside.document.body.appendChild(script);
      });
    }

    postMessage(data) {
      const told = () => this.inside.dispatchEvent(new MessageEvent("message", { data }));
      this.loaded.then(told);
    }
  };
}
