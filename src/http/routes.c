/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/routes.h"

const struct eo_route *const eo_routes[] = {eo_routes_service,
                                            eo_routes_session,
                                            eo_routes_examples,
                                            eo_routes_designs,
                                            eo_routes_analysis,
                                            eo_routes_jobs,
                                            eo_routes_events,
                                            eo_routes_history,
                                            eo_routes_export,
                                            eo_routes_report,
                                            eo_routes_tolerance,
                                            eo_routes_import,
                                            eo_routes_measurements,
                                            eo_routes_comparison,
                                            eo_routes_studies,
                                            eo_routes_reproduction,
                                            NULL};
