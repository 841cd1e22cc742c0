// SPDX-License-Identifier: Apache-2.0
// Okabe and Ito, "Color Universal Design", 2008: eight colours that people with any colour vision
// tell apart. Without their black, which is not seen on a dark page.
export const kOrange = '#e69f00', kSky = '#56b4e9', kGreen = '#2fbf8f', kYellow = '#f0e442',
             kBlue = '#4a9fe0', kVermilion = '#f0713c', kPurple = '#dd8fbf', kGrey = '#aab4c0';

export const kCurves = [kSky, kOrange, kGreen, kYellow, kPurple, kVermilion, kBlue, kGrey];
/// Curves differ by their dashes, too.
export const kDashes: number[][] = [[], [8, 4], [2, 3], [10, 3, 2, 3], [5, 5], [1, 4], [12, 6], [3, 1]];
export const kDashNames = ['solid', 'dashed', 'dotted', 'dash and dot', 'dashed', 'dotted', 'long dashes', 'dense dots'];

/// States are told by a sign and a word; the colour only helps.
export const kStateSigns = ['●', '▲', '✖', '◼'];
export const kStateColours = [kGreen, kYellow, kVermilion, kVermilion];
