// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
'use strict';
for (const pair of document.querySelectorAll('.pair')) {
  const slider = pair.querySelector('input');
  slider.oninput = () => pair.style.setProperty('--split', slider.value + '%');
}
for (const figure of document.querySelectorAll('.choice')) {
  const shown = figure.querySelectorAll('.pair img'), all = figure.querySelectorAll('[hidden] img');
  figure.querySelectorAll('select').forEach((select, side) => {
    select.onchange = () => { shown[side].src = all[select.selectedIndex].src; };
  });
}
