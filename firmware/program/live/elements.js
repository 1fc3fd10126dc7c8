// SPDX-License-Identifier: Apache-2.0
"use strict";

/** What the scripts of the live pages share. */
const byId = (id) => document.getElementById(id);
const element = (tag, className, text) => {
  const made = document.createElement(tag);
  if (className) made.className = className;
  if (text !== undefined) made.textContent = text;
  return made;
};
const inWords = (name) => String(name).replaceAll("_", " ");
