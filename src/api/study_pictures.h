// The pictures of a study's report, from its scenes.
#pragma once

#include "api/prepared_study.h"
#include "study/study_pictures.h"

namespace skybake {

/// Maps of the receivers and of the plan's surroundings, the skies of chosen samples (all free points where there are
/// few, else those that lose most, come nearest to the threshold, or fare worst), and the shadows at whole hours of the
/// rule's days: of the plan and what it newly shades, or of the city where there is no plan. `study` was made from
/// `prepared`.
StudyPictures study_pictures(const Rule& rule, const PreparedStudy& prepared, const Study& study, Progress& progress);

}  // namespace skybake
