#pragma once

#include <cstddef>

#include "proofmass/characterise/noise_analysis.hpp"

// Notes of a noise analysis, in sentences.
namespace proofmass::characterise {

/// Notes gaps; left_out: samples that the statistic could not use.
void note_missing(NoiseAnalysis& analysis, std::size_t left_out);

/// Notes the detected events.
void note_stationarity(NoiseAnalysis& analysis);

void note_events(NoiseAnalysis& analysis, bool excluded);

/// Notes the quantisation step relative to the spread of the samples.
void note_resolution(NoiseAnalysis& analysis, double spread);

/// Notes the model's fit and its limitations.
void note_model(NoiseAnalysis& analysis);

}  // namespace proofmass::characterise
