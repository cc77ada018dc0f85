// What the theme leaves out for those who use a keyboard or a screen reader.
document$.subscribe(() => {
  document.querySelectorAll("[data-md-component=search]").forEach((e) => e.setAttribute("aria-label", "Search"));
  document.querySelectorAll(".md-code__nav").forEach((e, i) => e.setAttribute("aria-label", `Code ${i + 1}`));
  document.querySelectorAll("th:empty").forEach((e) => e.replaceWith(document.createElement("td")));
  document.querySelectorAll("pre > code, .md-typeset__scrollwrap").forEach((e) => e.setAttribute("tabindex", "0"));
});
