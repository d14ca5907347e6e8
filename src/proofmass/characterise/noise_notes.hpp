#pragma once

#include <cstddef>

#include "proofmass/characterise/noise_analysis.hpp"

// What a noise analysis tells besides its figures, in sentences.
namespace proofmass::characterise {

/// Of gaps; left_out: samples that the statistic could not use.
void note_missing(NoiseAnalysis& analysis, std::size_t left_out);

/// Of the events that were found.
void note_stationarity(NoiseAnalysis& analysis);

void note_events(NoiseAnalysis& analysis, bool excluded);

/// Of the converter's step beside the readings' spread.
void note_resolution(NoiseAnalysis& analysis, double spread);

/// Of the model's fit and what it leaves open.
void note_model(NoiseAnalysis& analysis);

}  // namespace proofmass::characterise
